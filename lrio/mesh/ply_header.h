#pragma once
// Parses PLY headers and maps vertex properties to attributes. Internal to lrio.

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
    ComponentType type = ComponentType::f32;  ///< type of the value or of a list's items
    bool is_list = false;
    ComponentType count_type = ComponentType::u8;  ///< type of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::size_t line = 0;
    std::vector<PlyProperty> properties;
};

/// A line `comment lacedring attribute COMPONENTS FLAGS NAME`, which write_ply writes for each attribute. The notes
/// group the vertex's properties in order. FLAGS is the sum of 1 if the attribute is normalized and 2 if it is v_up.
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

/// The first attribute is POSITION. Errors: malformed (x, y or z is missing).
Result<std::vector<PlyAttribute>> plan_ply_attributes(const PlyElement& vertex,
                                                      const std::vector<PlyAttributeNote>& notes);

/// Escapes a name for comment lines: '%', control characters and leading or trailing blanks become %XX.
std::string escape_ply_name(std::string_view name);
std::string unescape_ply_name(std::string_view name);

inline constexpr std::string_view ply_note_prefix = "lacedring attribute ";

}  // namespace lacedring::detail
