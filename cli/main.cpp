#include "command_line.h"

#ifdef _WIN32
#include <cstdio>
#include <string>
#include <vector>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
// Beneath it, which it needs.
#include <shellapi.h>

// What main() is given there is in some code page, which names of files may not survive; and libstdc++ takes names byte
// by byte (path(std::string)), which only those in ASCII do.
int main() {
  constexpr int kBadOptions = 2;
  int count = 0;
  wchar_t** const wide = CommandLineToArgvW(GetCommandLineW(), &count);
  std::vector<std::string> words;
  for (int i = 0; i < count; ++i) {
    words.emplace_back();
    for (const wchar_t* c = wide[i]; *c != 0; ++c) {
      // How the program itself is called does not matter.
      if (*c >= 0x80 && i > 0) {
        std::fputs("octafront: letters beyond ASCII, in names of files too, are not taken on Windows yet\n", stderr);
        return kBadOptions;
      }
      words.back() += *c < 0x80 ? static_cast<char>(*c) : '?';
    }
  }
  LocalFree(wide);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return octafront_command_line(count, argv.data());
}
#else
int main(int argc, char** argv) {
  return octafront_command_line(argc, argv);
}
#endif
