#include "app/report/lr_contents.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/print.h"

namespace lacedring::app {
namespace {

bool has_section(const LrContents& lr, std::string_view kind) {
    return std::ranges::any_of(lr.sections, [kind](const LrSection& section) { return section.kind == kind; });
}

bool is_attribute(const LrSection& section) {
    return section.kind == "attribute" || section.kind == "vertices";
}

/// The kind of the section that holds the triangles.
std::string connectivity(const LrContents& lr) {
    for (const LrSection& section : lr.sections) {
        if (!is_attribute(section) && section.kind != "seams" && !section.kind.ends_with("_order")) return section.kind;
    }
    return "";
}

}  // namespace

const char* type_name(ComponentType type) {
    constexpr const char* kNames[] = {"i8", "u8", "i16", "u16", "i32", "u32", "f32", "f64"};
    return kNames[static_cast<std::size_t>(type)];
}

nlohmann::ordered_json to_json(const LrContents& lr) {
    nlohmann::ordered_json sections = nlohmann::ordered_json::array();
    for (const LrSection& section : lr.sections) {
        nlohmann::ordered_json entry = {{"kind", section.kind}, {"bytes", section.bytes}, {"stored", section.stored}};
        if (is_attribute(section)) {
            entry["name"] = section.name;
            entry["type"] = type_name(section.type);
            entry["components"] = section.components;
            if (lr.copies > 0) entry["per_copy"] = section.per_copy;
        }
        if (section.kind == "vertices") {
            entry["mapping"] = section.mapping;
            entry["max_error"] = section.largest_error;
        }
        sections.push_back(std::move(entry));
    }
    return {{"version", lr.version},
            {"format", connectivity(lr)},
            {"bytes", lr.bytes},
            {"vertices", lr.vertices},
            {"copies", lr.copies > 0 ? lr.copies : lr.vertices},
            {"vertex_order", has_section(lr, "vertex_order")},
            {"corner_order", has_section(lr, "corner_order")},
            {"sections", sections}};
}

void print_contents(const LrContents& lr) {
    print("  {:<22} .lr version {}, {} bytes, {}\n", "file", lr.version, lr.bytes,
          has_section(lr, "vertex_order") && has_section(lr, "corner_order") ? "the input's order is kept"
                                                                             : "the input's order is not kept");
    for (const LrSection& section : lr.sections) {
        std::string what = section.kind, how;
        if (is_attribute(section)) {
            what = fmt::format("{} ({} x {})", printable(section.name), section.components, type_name(section.type));
        }
        if (section.kind == "vertices") {
            how = fmt::format(", {:.2f} bits a {}, {}",
                              8 * static_cast<double>(section.bytes) / (section.per_copy ? lr.copies : lr.vertices),
                              section.per_copy ? "copy" : "vertex", section.mapping);
            how +=
                section.largest_error > 0 ? fmt::format(", largest error {:.3g}", section.largest_error) : ", lossless";
        }
        print("    {:<30}{:>12} bytes{}{}\n", what, section.bytes, section.stored ? ", in storage form" : "", how);
    }
}

}  // namespace lacedring::app
