#include "io/tables/certificate_text.h"

#include <gtest/gtest.h>

#include "kernels/error.h"

namespace vfplan {
namespace {

TEST(CertificateText, ReadsAsItIsWritten) {
    NetworkProof proof;
    proof.bound = 2;
    proof.gone = {{3, 4}};
    proof.root_piece = 1;
    proof.lines = {{LineKind::cover, 0, {}}, {LineKind::arcs, 2, {1, 4}}};
    proof.cases = {{4, {}}, {-1, {{0, 7}}}, {-1, {{0, 1}, {1, 1LL << 40}}}};
    const std::string text = text_of({{proof, {1, {}, -1, 5, {}, {{-1, {}}}}}});
    EXPECT_EQ(text,
              "vfplan certificate 1\nscale 16777216\nnetwork 0 bound 2\nroot piece 1\ngone 3 by 4\n"
              "line 0 cover 0\nline 1 arcs 2 in 1 4\ncase branch 4\ncase leaf\nweight 0 7\n"
              "case leaf\nweight 0 1\nweight 1 1099511627776\n"
              "network 1 bound 1\nroot station 5\ncase leaf\nend\n");
    EXPECT_EQ(text_of(certificate_of(text, "it")), text);
    for (std::size_t cut = 0; cut < text.size(); ++cut) {
        EXPECT_THROW(certificate_of(text.substr(0, cut), "it"), IoError) << cut;
    }
    const std::string more = text + "end\n";
    EXPECT_THROW(certificate_of(more, "it"), IoError);
}

}  // namespace
}  // namespace vfplan
