#include "command_line.h"

int main(int argc, char** argv) {
  return octafront_command_line(argc, argv);
}
