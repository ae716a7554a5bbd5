#include "formats/containers/netcdf_writer.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace octafront::io {
namespace {

constexpr std::uint32_t kDimensions = 10, kVariables = 11, kAttributes = 12;

constexpr std::uint64_t padded(std::uint64_t bytes) {
  return (bytes + 3) / 4 * 4;
}
constexpr std::uint64_t size_of(NetcdfWriter::Type type) {
  return type == NetcdfWriter::kChar ? 1 : type == NetcdfWriter::kDouble ? 8 : 4;
}

}  // namespace

std::uint32_t NetcdfWriter::dimension(std::string name, std::uint64_t length) {
  dimensions_.emplace_back(std::move(name), length);
  return static_cast<std::uint32_t>(dimensions_.size() - 1);
}

void NetcdfWriter::variable(std::string name, Type type, std::vector<std::uint32_t> dimensions, ValueAt value,
                            std::vector<Attribute> attributes) {
  Variable v{std::move(name), type, std::move(dimensions), std::move(value), std::move(attributes)};
  for (const std::uint32_t d : v.dimensions)
    if (dimensions_[d].second == 0)
      v.of_records = true;
    else
      v.count *= dimensions_[d].second;
  variables_.push_back(std::move(v));
}

template <class T>
void NetcdfWriter::put(T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  std::reverse(bytes.begin(), bytes.end());
  file_.write(bytes.data(), bytes.size());
}

void NetcdfWriter::count(std::uint64_t n) {
  long_counts_ ? put(n) : put(static_cast<std::uint32_t>(n));
}

void NetcdfWriter::text(const std::string& name) {
  count(name.size());
  file_.write(name);
  file_.write(std::string(padded(name.size()) - name.size(), '\0'));
}

void NetcdfWriter::list_head(std::uint32_t tag, std::size_t size) {
  put(size == 0 ? std::uint32_t{0} : tag);
  count(size);
}

void NetcdfWriter::put_attributes(const std::vector<Attribute>& all) {
  list_head(kAttributes, all.size());
  for (const auto& [name, value] : all) {
    text(name);
    if (const auto* words = std::get_if<std::string>(&value)) {
      put<std::uint32_t>(kChar);
      text(*words);
    } else if (const auto* number = std::get_if<std::int32_t>(&value)) {
      put<std::uint32_t>(kInt);
      count(1);
      put(*number);
    } else {
      put<std::uint32_t>(kFloat);
      count(1);
      put(std::get<float>(value));
    }
  }
}

std::uint64_t NetcdfWriter::bytes_of(const Variable& v) {
  return padded(v.count * size_of(v.type));
}

void NetcdfWriter::put_header(const std::vector<std::uint64_t>& begins) {
  file_.write(long_counts_ ? std::string_view("CDF\x05") : std::string_view("CDF\x02"));
  count(has_record_);
  list_head(kDimensions, dimensions_.size());
  for (const auto& [name, length] : dimensions_) {
    text(name);
    count(length);
  }
  put_attributes(attributes_);
  list_head(kVariables, variables_.size());
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const Variable& v = variables_[i];
    text(v.name);
    count(v.dimensions.size());
    for (const std::uint32_t d : v.dimensions) count(d);
    put_attributes(v.attributes);
    put<std::uint32_t>(v.type);
    count(bytes_of(v));
    put(begins[i]);
  }
}

void NetcdfWriter::put_values(const Variable& v) {
  for (std::uint64_t i = 0; i < v.count; ++i) {
    const Value value = v.value(i);
    if (v.type == kDouble) {
      put(std::get<double>(value));
    } else if (v.type == kInt) {
      put(std::get<std::int32_t>(value));
    } else {
      const char c = static_cast<char>(std::get<std::int32_t>(value));
      file_.write(&c, 1);
    }
  }
  const std::uint64_t bytes = v.count * size_of(v.type);
  file_.write(std::string(padded(bytes) - bytes, '\0'));
}

void NetcdfWriter::write(bool one_record) {
  has_record_ = one_record;
  constexpr std::uint64_t kMostOfOne = (std::uint64_t{1} << 32) - 4, kMostLength = (std::uint64_t{1} << 31) - 4;
  for (const Variable& v : variables_) long_counts_ = long_counts_ || bytes_of(v) > kMostOfOne;
  for (const auto& [name, length] : dimensions_) long_counts_ = long_counts_ || length > kMostLength;
  // The header does not grow with what stands in it: written once to see where values begin, then again.
  const std::uint64_t start = file_.position();
  std::vector<std::uint64_t> begins(variables_.size(), 0);
  put_header(begins);
  std::uint64_t at = file_.position();
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    begins[i] = at;
    if (is_written(variables_[i])) at += bytes_of(variables_[i]);
  }
  file_.restart(start);
  put_header(begins);
  for (const Variable& v : variables_)
    if (is_written(v)) put_values(v);
}

}  // namespace octafront::io
