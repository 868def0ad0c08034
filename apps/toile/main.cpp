#include "apps/toile/command_line.h"

int main(int argc, char** argv) { return toile::run_command_line(argc, argv); }
