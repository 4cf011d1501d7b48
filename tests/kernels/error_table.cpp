// SPDX-License-Identifier: MIT
#include "error_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "kernel_fixture.h"

namespace quincunx::testing {
namespace {

struct Row {
  long long values = 0;
  double error = 0;
  double ulp = 0;        // the largest error in last places of the largest tap
  double bound_ulp = 0;  // the bound of that value, likewise
  double of_bound = 0;   // the largest error / bound
};

std::map<std::string, Row>& rows() {
  static std::map<std::string, Row> all;
  return all;
}

double last_place(PixelFormat format, double value) {
  if (format == PixelFormat::kRGBA8) return 1;  // one code
  const bool half = format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F;
  const int exponent = std::max(std::ilogb(value), half ? -14 : -126);
  return std::ldexp(1.0, exponent - (half ? 10 : 23));
}

const char* unit_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRGBA8:
      return "8 bits";
    case PixelFormat::kRGBA16F:
    case PixelFormat::kRG16F:
      return "half";
    default:
      return "float";
  }
}

// "Variants/Scale" and "Matches/bilinear_buffer_RGBA16F_to_RGBA32F" become "Scale bilinear".
std::string label_of(const ::testing::TestInfo& test) {
  const std::string suite = test.test_suite_name();
  std::string label = suite.substr(suite.find('/') + 1);
  const std::string name = test.name();
  if (name.find('/') == std::string::npos) return label;
  std::istringstream words(name.substr(name.find('/') + 1));
  for (std::string word; std::getline(words, word, '_');) {
    const bool idle = word == "buffer" || word == "image" || word == "to" || word.starts_with("RG");
    if (!idle) label += " " + word;
  }
  return label;
}

class WriteTable : public ::testing::Environment {
 public:
  void TearDown() override {
    const char* path = std::getenv("QUINCUNX_ERROR_TABLE");
    if (path == nullptr || rows().empty()) return;
    std::ofstream file(path);
    const DeviceInfo& info = device().info();
    file << fmt::format("{}, {} {}\n\n", info.name, info.platform, info.driver)
         << "| pass and variant | stored | values | largest error | in ulp | bound there | error / bound |\n"
         << "|---|---|---|---|---|---|---|\n";
    for (const auto& [name, row] : rows()) {
      file << fmt::format("| {} | {} | {:.2g} | {:.3g} | {:.3g} | {:.2f} |\n", name, row.values, row.error,
                          row.ulp, row.bound_ulp < 1e-3 ? 0 : row.bound_ulp, row.of_bound);
    }
    EXPECT_TRUE(file.flush()) << "cannot write " << path;
  }
};

[[maybe_unused]] const ::testing::Environment* const kWriteTable =
    ::testing::AddGlobalTestEnvironment(new WriteTable);

}  // namespace

void record_error(const ObservedError& observed) {
  if (observed.bound == 0 && observed.error == 0) return;
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  // The label is made once a test, the values are many.
  static const ::testing::TestInfo* labelled = nullptr;
  static std::string label;
  if (test != labelled) {
    labelled = test;
    label = label_of(*test);
  }
  Row& row = rows()[label + " | " + unit_of(observed.stored)];
  const double place = last_place(observed.stored, observed.largest);
  ++row.values;
  row.error = std::max(row.error, observed.error);
  row.of_bound = std::max(row.of_bound, observed.error / observed.bound);
  if (observed.error / place < row.ulp) return;
  row.ulp = observed.error / place;
  row.bound_ulp = observed.bound / place;
}

}  // namespace quincunx::testing
