// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "bench/speed_error/bench_fields.h"

namespace quincunx::bench {
namespace {

// RFC 4180.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string safe = "\"";
  for (const char c : text)
    safe += c == '"' ? std::string("\"\"") : std::string(1, c);
  return safe + "\"";
}

// Flattens a row: the fields of a struct inside become columns "ms_median".
class Columns {
 public:
  template <typename T>
  void operator()(const char* name, T& value) {
    const std::string full = prefix_.empty() ? name : prefix_ + "_" + name;
    if constexpr (requires(Columns io) { fields(io, value); }) {
      const std::string outer = std::exchange(prefix_, full);
      fields(*this, value);
      prefix_ = outer;
    } else {
      add(full, text_of(value));
    }
  }

  const std::string& names() const { return names_; }
  const std::string& cells() const { return cells_; }

 private:
  void add(const std::string& name, const std::string& text) {
    const char* separator = names_.empty() ? "" : ",";
    names_ += separator + name;
    cells_ += separator + quoted(text);
  }

  static std::string text_of(const std::string& value) { return value; }
  static std::string text_of(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "inf";
  }
  static std::string text_of(const std::optional<double>& value) { return value ? text_of(*value) : ""; }
  static std::string text_of(const std::vector<std::string>& values) {
    return fmt::format("{}", fmt::join(values, " "));
  }
  static std::string text_of(std::integral auto value) { return fmt::format("{}", value); }

  std::string prefix_;
  std::string names_;
  std::string cells_;
};

}  // namespace

std::string to_csv(const BenchResult& result) {
  std::string text;
  // Also without rows there are names.
  for (std::size_t i = 0; i < std::max<std::size_t>(result.rows.size(), 1); ++i) {
    Row row = result.rows.empty() ? Row{} : result.rows[i];
    Columns columns;
    fields(columns, row);
    if (i == 0) text = columns.names() + "\n";
    if (!result.rows.empty()) text += columns.cells() + "\n";
  }
  return text;
}

}  // namespace quincunx::bench
