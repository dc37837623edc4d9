// The command line.
#pragma once

namespace vfplan {

// Runs the program; returns its exit code (docs/cli.md). Catches everything.
int run_cli(int argc, char** argv);

}  // namespace vfplan
