#pragma once
// The sections of an .lr file, for info and stats.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lacedring/lr_file.hpp"

namespace lacedring::app {

const char* type_name(ComponentType type);

/// {"version","format","bytes","vertices","copies","vertex_order","corner_order",
/// "sections":[{"kind","bytes","stored","name","type","components","per_copy","mapping","max_error"}]}
nlohmann::ordered_json to_json(const LrContents& lr);

/// Prints the same as indented lines of text.
void print_contents(const LrContents& lr);

}  // namespace lacedring::app
