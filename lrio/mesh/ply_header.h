#pragma once
// The header of a PLY file, and which attributes its vertex properties make. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"

namespace lacedring::detail {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
    std::string name;
    ComponentType type = ComponentType::f32;  ///< of the value, or of a list's items
    bool is_list = false;
    ComponentType count_type = ComponentType::u8;  ///< of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::size_t line = 0;
    std::vector<PlyProperty> properties;
};

/// A line `comment lacedring attribute COMPONENTS FLAGS NAME`, with which write_ply keeps names and groups. The
/// attributes take the vertex's properties in order. FLAGS is the sum of 1 for a normalized attribute and 2 for one
/// that is v_up.
struct PlyAttributeNote {
    std::uint8_t components = 1;
    bool normalized = false;
    bool v_up = false;
    std::string name;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::vector<PlyAttributeNote> notes;
    std::size_t bytes = 0;  ///< where the data begins
};

Result<PlyHeader> parse_ply_header(std::string_view bytes);

/// An attribute (without data), and the vertex property that each component comes from.
struct PlyAttribute {
    Attribute attribute;
    std::vector<std::size_t> properties;
};

/// The first one is POSITION. An error if x, y and z are not there.
Result<std::vector<PlyAttribute>> plan_ply_attributes(const PlyElement& vertex,
                                                      const std::vector<PlyAttributeNote>& notes);

/// Names in comment lines: '%', control characters and leading or trailing blanks as %XX.
std::string escape_ply_name(std::string_view name);
std::string unescape_ply_name(std::string_view name);

inline constexpr std::string_view ply_note_prefix = "lacedring attribute ";

}  // namespace lacedring::detail
