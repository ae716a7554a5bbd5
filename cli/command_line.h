#pragma once

/// The whole tool. A C function, so that it can lie in a library that shows no others: that of the Python package.
extern "C" int octafront_command_line(int argc, char** argv);
