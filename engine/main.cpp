#include "engine/cli.h"

int main(int argc, char** argv) { return vfplan::run_cli(argc, argv); }
