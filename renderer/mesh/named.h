#pragma once
// Tables of a user's choices (views, sources, paths, ...) with their names.

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacedring::gpu {

template <class Choice>
struct Named {
    const char* name;  ///< on the command line, in scripts and in JSON
    Choice value;
    const char* label;  ///< in the viewer's panels
};

/// The choice with this name in a table, if any.
template <class Table>
auto find_named(const Table& table, std::string_view name) {
    std::optional<decltype(table.begin()->value)> out;
    for (const auto& named : table) {
        if (named.name == name) out = named.value;
    }
    return out;
}

template <class Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> out;
    for (const auto& named : table) out.emplace_back(named.name);
    return out;
}

}  // namespace lacedring::gpu
