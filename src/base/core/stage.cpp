#include "base/core/stage.h"

#include <utility>

namespace octafront {

void Stage::count(std::string key, double value) const {
  report_.count(std::move(key), value);
}

void Stage::note(std::string sentence) const {
  report_.notes.push_back(std::move(sentence));
}

void Stage::note(Finding finding) const {
  report_.note(std::move(finding));
}

}  // namespace octafront
