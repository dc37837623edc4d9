// The batch script as text; e2e/slurm_test.py gives it to Slurm.
#include "engine/cli/submit.h"

#include <gtest/gtest.h>

#include "engine/runtime/shell_word.h"

#include <cstdio>
#include <memory>
#include <string>

#include "kernels/error.h"

namespace vfplan {
namespace {

bool has(const std::string& text, const std::string& line) {
    return text.find("\n" + line + "\n") != std::string::npos;
}

SubmitOptions two_nodes() {
    SubmitOptions o;
    o.job = "/jobs/town.toml";
    o.out = "/runs/town";
    o.program = "/opt/bin/vfplan";
    o.folder = "/jobs";
    o.nodes = 2;
    return o;
}

TEST(Submit, NodeShapeIsTheLeastOfThePartition) {
    const std::string lines = "main* 2 64\nmain* 4 48\nsmall 1 8\n";
    EXPECT_EQ(node_shape(lines, "")->sockets, 2);
    EXPECT_EQ(node_shape(lines, "")->processors, 48);
    EXPECT_EQ(node_shape(lines, "main")->processors, 48);
    EXPECT_EQ(node_shape(lines, "small")->sockets, 1);
    EXPECT_FALSE(node_shape(lines, "none"));
    EXPECT_FALSE(node_shape("", ""));
    EXPECT_FALSE(node_shape("slurm_load_partitions: Unable to contact slurm controller", ""));
}

TEST(Submit, WholeNodesWithARankPerSocket) {
    const std::string s = batch_script(two_nodes(), NodeShape{2, 64}, true);
    for (const char* line :
         {"#SBATCH --nodes=2", "#SBATCH --ntasks-per-node=2", "#SBATCH --cpus-per-task=32",
          "#SBATCH --exclusive", "#SBATCH --mem=0", "#SBATCH --requeue",
          "#SBATCH --signal=B:TERM@120", "#SBATCH --open-mode=append",
          "#SBATCH --output='/runs/town.slurm-%j.log'", "#SBATCH --chdir='/jobs'", "ranks=4"}) {
        EXPECT_TRUE(has(s, line)) << line << "\n" << s;
    }
    EXPECT_EQ(s.find("--partition"), std::string::npos);
}

TEST(Submit, WishesOfThePerson) {
    SubmitOptions o = two_nodes();
    o.ranks_per_node = 3;
    o.threads = 5;
    o.time = "1-12";
    o.account = "me & co";
    o.partition = "small";
    const std::string s = batch_script(o, NodeShape{2, 64}, true);
    for (const char* line :
         {"#SBATCH --ntasks-per-node=3", "#SBATCH --cpus-per-task=5", "#SBATCH --time='1-12'",
          "#SBATCH --account='me & co'", "#SBATCH --partition='small'", "ranks=6"}) {
        EXPECT_TRUE(has(s, line)) << line << "\n" << s;
    }
    EXPECT_EQ(s.find("--exclusive"), std::string::npos);
}

TEST(Submit, WithoutMpiOneRank) {
    SubmitOptions o = two_nodes();
    EXPECT_THROW(batch_script(o, NodeShape{2, 64}, false), UsageError);
    o.nodes = 1;
    const std::string s = batch_script(o, NodeShape{2, 64}, false);
    EXPECT_TRUE(has(s, "#SBATCH --cpus-per-task=64")) << s;
    EXPECT_TRUE(has(s, "ranks=1")) << s;
    o.ranks_per_node = 2;
    EXPECT_THROW(batch_script(o, std::nullopt, false), UsageError);
}

TEST(Submit, UnknownNodesAreAskedWhenTheJobStarts) {
    const std::string s = batch_script(two_nodes(), std::nullopt, true);
    EXPECT_EQ(s.find("--cpus-per-task=\n"), std::string::npos);
    EXPECT_TRUE(has(s, "ranks=2")) << s;
    EXPECT_NE(s.find("SLURM_CPUS_ON_NODE / 1"), std::string::npos) << s;
}

// bash reads the program's words as they were, whatever they hold.
TEST(Submit, WordsSurviveTheShell) {
    SubmitOptions o = two_nodes();
    o.job = "/jobs/it's $HOME \"x\" `ls` \\ %j.toml";
    o.out = "/runs/a b; #c";
    o.sets = {"site.input=*.geojson", "plan.required=[[1, 2]]"};
    const std::string s = batch_script(o, std::nullopt, true);
    const auto from = s.find("program=(");
    const std::string line = s.substr(from, s.find("\nranks=") - from);
    const std::string command = "bash -c " + shell_word(line + "; printf '<%s>' \"${program[@]}\"");
    std::string text;
    {
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"),
                                                                   pclose);
        ASSERT_NE(pipe, nullptr);
        for (int c = 0; (c = std::fgetc(pipe.get())) != EOF;) text += static_cast<char>(c);
    }
    EXPECT_EQ(text, "</opt/bin/vfplan><run><" + o.job.string() + "><--out><" + o.out.string() +
                        "><--set><site.input=*.geojson><--set><plan.required=[[1, 2]]>");
}

TEST(Submit, PercentSignsAreNotPatternsOfTheLog) {
    SubmitOptions o = two_nodes();
    o.out = "/runs/100%j";
    EXPECT_TRUE(
        has(batch_script(o, std::nullopt, true), "#SBATCH --output='/runs/100%%j.slurm-%j.log'"));
}

TEST(Submit, LinesEndsAreRefused) {
    SubmitOptions o = two_nodes();
    o.partition = "a\n#SBATCH --uid=0";
    EXPECT_THROW(batch_script(o, std::nullopt, true), UsageError);
    o = two_nodes();
    o.out = "/runs/a\nb";
    EXPECT_THROW(batch_script(o, std::nullopt, true), UsageError);
}

}  // namespace
}  // namespace vfplan
