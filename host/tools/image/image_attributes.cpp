// SPDX-License-Identifier: MIT
#include "tools/image/image_attributes.h"

#include <cstring>
#include <optional>
#include <string>
#include <utility>

namespace quincunx::tools {
namespace {

using OIIO::TypeDesc;

const TypeDesc kPairOfFloats(TypeDesc::FLOAT, TypeDesc::VEC2);
const TypeDesc kEightFloats(TypeDesc::FLOAT, 8);

struct AttributeWriter {
  OIIO::ImageSpec& spec;
  const std::string& name;

  void operator()(const std::string& value) const { spec.attribute(name, value); }
  void operator()(int value) const { spec.attribute(name, value); }
  void operator()(float value) const { spec.attribute(name, value); }
  void operator()(const Vec2& value) const { spec.attribute(name, kPairOfFloats, &value); }
  void operator()(const Rational& value) const { spec.attribute(name, OIIO::TypeRational, &value); }
  void operator()(const Matrix& value) const { spec.attribute(name, OIIO::TypeMatrix44, value.data()); }
  void operator()(const Chromaticities& value) const { spec.attribute(name, kEightFloats, value.data()); }
};

template <typename Value>
AttributeValue copied(const OIIO::ParamValue& param) {
  Value value;
  std::memcpy(&value, param.data(), sizeof value);
  return value;
}

template <typename Number>
AttributeValue pair_of(const OIIO::ParamValue& param) {
  Number pair[2];
  std::memcpy(pair, param.data(), sizeof pair);
  return Vec2{static_cast<float>(pair[0]), static_cast<float>(pair[1])};
}

std::optional<AttributeValue> value_of(const OIIO::ParamValue& param) {
  const TypeDesc type = param.type();
  if (type == OIIO::TypeString) return param.get_string();
  if (type == OIIO::TypeInt) return param.get_int();
  if (type == OIIO::TypeFloat || type == TypeDesc(TypeDesc::DOUBLE)) return param.get_float();
  if (type == kPairOfFloats) return copied<Vec2>(param);
  if (type == TypeDesc(TypeDesc::DOUBLE, TypeDesc::VEC2)) return pair_of<double>(param);
  if (type == OIIO::TypeRational) return copied<Rational>(param);
  if (type == TypeDesc(TypeDesc::INT, TypeDesc::VEC2)) return pair_of<int>(param);
  if (type == OIIO::TypeMatrix44) return copied<Matrix>(param);
  if (type == kEightFloats) return copied<Chromaticities>(param);
  return std::nullopt;
}

}  // namespace

std::vector<Attribute> attributes_of(const OIIO::ImageSpec& spec) {
  std::vector<Attribute> attributes;
  for (const OIIO::ParamValue& param : spec.extra_attribs) {
    if (auto value = value_of(param)) attributes.push_back({param.name().string(), *std::move(value)});
  }
  return attributes;
}

void set_attributes(OIIO::ImageSpec& spec, std::span<const Attribute> attributes) {
  for (const Attribute& attribute : attributes)
    std::visit(AttributeWriter{spec, attribute.name}, attribute.value);
}

}  // namespace quincunx::tools
