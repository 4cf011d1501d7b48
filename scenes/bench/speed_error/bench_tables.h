// SPDX-License-Identifier: MIT
// Lists of like objects as tables: each name once, a line for each object. A third of the size of the objects, and
// what changed between two files shows line by line.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace quincunx::bench {

// The text of an object, with a line for each of its fields. A list of objects becomes a table,
//   {"columns": ["scene", "quality.psnr"], "data": [["pan", 31.2],
//   ["wires", 28.1]]}
// where a dot stands before the field of an object inside. All objects of a list have the same fields.
std::string text_with_tables(const nlohmann::ordered_json& object);

// The objects again, of a table that stands as a field of `object`; what is no table stays as it is. Throws
// std::exception where a row has not as many cells as there are columns.
nlohmann::ordered_json without_tables(nlohmann::ordered_json object);

}  // namespace quincunx::bench
