#include "command_line.h"

#ifdef _WIN32
#include <string>
#include <vector>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
// Beneath it, which it needs.
#include <shellapi.h>

namespace {

std::string in_utf8(const wchar_t* wide) {
  const auto converted = [&](char* to, int room) {
    return WideCharToMultiByte(CP_UTF8, 0, wide, -1, to, room, nullptr, nullptr);
  };
  std::string text(static_cast<std::size_t>(converted(nullptr, 0)), '\0');
  converted(text.data(), static_cast<int>(text.size()));
  text.pop_back();  // the zero at the end
  return text;
}

}  // namespace

// What main() is given there is in some code page, which names of files may not survive.
int main() {
  int count = 0;
  wchar_t** const wide = CommandLineToArgvW(GetCommandLineW(), &count);
  std::vector<std::string> words;
  for (int i = 0; i < count; ++i) words.push_back(in_utf8(wide[i]));
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
