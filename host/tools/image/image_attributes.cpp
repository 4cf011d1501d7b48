// SPDX-License-Identifier: MIT
#include "tools/image/image_attributes.h"

#include <ImfChromaticitiesAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <cstring>
#include <optional>
#include <string>
#include <utility>

namespace quincunx::tools {
namespace {

struct AttributeWriter {
  Imf::Header& header;
  const std::string& name;

  void operator()(const std::string& value) const { insert(value); }
  void operator()(int value) const { insert(value); }
  void operator()(float value) const { insert(value); }
  void operator()(const Vec2& value) const { insert(Imath::V2f(value.x, value.y)); }
  void operator()(const Rational& value) const {
    insert(Imf::Rational(value.numerator, static_cast<unsigned>(value.denominator)));
  }
  void operator()(const Matrix& value) const {
    Imath::M44f matrix;
    std::memcpy(matrix.getValue(), value.data(), sizeof value);
    insert(matrix);
  }
  void operator()(const Chromaticities& value) const {
    const auto& v = value;
    insert(Imf::Chromaticities({v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]}));
  }

  template <typename Value>
  void insert(const Value& value) const {
    header.insert(name, Imf::TypedAttribute<Value>(value));
  }
};

// The attribute's value, if it is of this type.
template <typename Value>
const Value* as(const Imf::Attribute& attribute) {
  const auto* typed = dynamic_cast<const Imf::TypedAttribute<Value>*>(&attribute);
  return typed != nullptr ? &typed->value() : nullptr;
}

template <typename Pair>
Vec2 rounded(const Pair& pair) {
  return {static_cast<float>(pair.x), static_cast<float>(pair.y)};
}

std::optional<AttributeValue> value_of(const Imf::Attribute& attribute) {
  if (const auto* text = as<std::string>(attribute)) return *text;
  if (const auto* number = as<int>(attribute)) return *number;
  if (const auto* number = as<float>(attribute)) return *number;
  if (const auto* number = as<double>(attribute)) return static_cast<float>(*number);
  if (const auto* pair = as<Imath::V2f>(attribute)) return rounded(*pair);
  if (const auto* pair = as<Imath::V2d>(attribute)) return rounded(*pair);
  if (const auto* pair = as<Imath::V2i>(attribute)) return rounded(*pair);
  if (const auto* ratio = as<Imf::Rational>(attribute)) return Rational{ratio->n, static_cast<int>(ratio->d)};
  if (const auto* of_exr = as<Imath::M44f>(attribute)) {
    Matrix matrix;
    std::memcpy(matrix.data(), of_exr->getValue(), sizeof matrix);
    return matrix;
  }
  if (const auto* xy = as<Imf::Chromaticities>(attribute)) {
    return Chromaticities{xy->red.x,  xy->red.y,  xy->green.x, xy->green.y,
                          xy->blue.x, xy->blue.y, xy->white.x, xy->white.y};
  }
  return std::nullopt;
}

}  // namespace

std::vector<Attribute> attributes_of(const Imf::Header& header) {
  std::vector<Attribute> attributes;
  for (auto found = header.begin(); found != header.end(); ++found) {
    if (auto value = value_of(found.attribute())) attributes.push_back({found.name(), *std::move(value)});
  }
  return attributes;
}

void set_attributes(Imf::Header& header, std::span<const Attribute> attributes) {
  for (const Attribute& attribute : attributes)
    std::visit(AttributeWriter{header, attribute.name}, attribute.value);
}

}  // namespace quincunx::tools
