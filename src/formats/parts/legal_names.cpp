#include "formats/parts/legal_names.h"

#include "formats/containers/scanner.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront::io {
namespace {

constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr char to_upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

}  // namespace

std::string LegalNames::key(std::string_view name) const {
  std::string all(name);
  if (rules_.ignores_case) std::transform(all.begin(), all.end(), all.begin(), to_lower);
  return all;
}

std::string LegalNames::fit(std::string_view name) const {
  std::string made;
  for (const char c : name.substr(0, rules_.longest)) {
    const bool good = is_letter(c) || is_digit(c) || rules_.also.find(c) != std::string_view::npos;
    made += !good ? '_' : rules_.upper_case ? to_upper(c) : c;
  }
  if (made.empty() || (rules_.letter_first && !is_letter(made[0])))
    made.insert(made.begin(), rules_.upper_case ? 'N' : 'n');
  made.resize(std::min(made.size(), rules_.longest));
  return made;
}

std::string LegalNames::with_ending(const std::string& base, std::string_view ending) const {
  return base.substr(0, rules_.longest - ending.size()).append(ending);
}

std::string LegalNames::legal(std::string_view name, const LegalNames* apart) {
  const auto is_taken = [&](const std::string& made) { return has(made) || (apart && apart->has(made)); };
  std::string base = fit(name);
  if (apart && apart->has(base)) base = with_ending(base, "_surface");
  std::string made = base;
  for (int n = 2; is_taken(made); ++n) made = with_ending(base, fmt::format("_{}", n));
  taken_.insert(key(made));
  // That all is in upper case is no news.
  if (key(made) != key(name)) changed_.push_back(fmt::format("\"{}\" is {}", one_line(name), made));
  return made;
}

std::string LegalNames::note() const {
  if (changed_.empty()) return {};
  constexpr std::size_t kMost = 5;
  std::string all = "names were changed to what the format takes: ";
  for (std::size_t i = 0; i < std::min(kMost, changed_.size()); ++i) all += (i > 0 ? ", " : "") + changed_[i];
  return changed_.size() > kMost ? all + fmt::format(" and {} more", changed_.size() - kMost) : all;
}

std::string ShortNames::fitting(const std::string& name) {
  const auto known = known_.find(name);
  if (known != known_.end()) return known->second;
  const auto cut_to = [&](std::size_t end) {
    const auto is_inside = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    while (end > 0 && end < name.size() && is_inside(name[end])) --end;
    return name.substr(0, end);
  };
  std::string made = cut_to(longest_);
  for (int n = 2; taken_.contains(made); ++n) {
    const std::string ending = fmt::format("_{}", n);
    made = cut_to(longest_ - ending.size()) + ending;
  }
  taken_.insert(made);
  return known_[name] = made;
}

std::vector<std::string> legal_names(MeshOutput& out, const MeshParts& mesh, const NameRules& rules,
                                     std::span<const Part::Origin> of) {
  LegalNames of_elements(rules), of_others(rules);
  std::vector<std::string> names(mesh.parts().size());
  for (const bool elements : {true, false})
    for (std::size_t p = 0; p < names.size(); ++p) {
      const Part& part = mesh.parts()[p];
      const bool is_wanted = std::find(of.begin(), of.end(), part.origin) != of.end();
      if (!is_wanted || (part.kind == NamedSet::Kind::kElements) != elements) continue;
      const bool is_apart = rules.one_space && part.kind == NamedSet::Kind::kFaces;
      names[p] = (elements ? of_elements : of_others).legal(part.name, is_apart ? &of_elements : nullptr);
    }
  out.note(of_elements.note());
  out.note(of_others.note());
  return names;
}

std::string one_line(std::string_view name) {
  std::string out(name);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return out;
}

}  // namespace octafront::io
