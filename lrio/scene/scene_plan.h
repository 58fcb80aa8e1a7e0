#pragma once
// Plans the compression of a glTF scene: groups its triangle primitives by shared vertices. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_file.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/json_text.h"

namespace lacedring::detail {

/// A primitive of the document.
struct PrimitivePlace {
    std::uint32_t mesh = 0, primitive = 0;
};

/// An index list, and the primitives that use it.
struct ScenePart {
    std::optional<std::uint32_t> indices;  ///< accessor; none: the vertices in order
    int mode = 4;                          ///< triangles, strip or fan
    std::vector<PrimitivePlace> primitives;
};

struct SceneAttribute {
    std::uint32_t accessor = 0;
    /// The name in the stream: glTF's name, then "@T" if it is of morph target T, then "#N" if it is the N-th accessor
    /// of that name.
    std::string name;
};

/// The vertices that some primitives share: two accessors are of the same set if a primitive uses both, as attributes,
/// morph targets or indices. All attribute accessors of a set have the same count.
struct VertexSet {
    std::size_t vertices = 0;
    std::vector<SceneAttribute> attributes;  ///< the first one is POSITION
    std::vector<ScenePart> parts;
    bool keep_order = false;  ///< something refers to the vertices or triangles by index
};

struct ScenePlan {
    std::vector<VertexSet> sets;
    std::map<std::string, std::size_t> not_compressed;  ///< number of primitives for each reason
};

/// Makes the plan. Checks accessors, but reads no values. Errors: malformed (primitives that violate glTF).
Result<ScenePlan> plan_scene(const JsonValue& document, GltfFile& file, bool keep_order);

/// Calls visit(name, accessor) for each attribute of a primitive, and with "NAME@TARGET" for those of morph targets.
/// Stops if visit returns an error, and returns it. Errors: malformed (not an accessor index).
template <class Visit>
Result<void> visit_attributes(const JsonValue& primitive, Visit visit) {
    const auto all = [&](const JsonValue* attributes, const std::string& suffix) -> Result<void> {
        if (attributes == nullptr || !attributes->is_object()) return {};
        for (const JsonValue::Member& member : attributes->members) {
            const auto accessor = member.value.integer();
            std::string name = plain_key(member.key);
            if (!accessor || *accessor >= UINT32_MAX) return malformed("{}: no accessor", shown(name));
            if (auto good = visit(name + suffix, static_cast<std::uint32_t>(*accessor)); !good) return good;
        }
        return {};
    };
    if (auto good = all(primitive.find("attributes"), ""); !good) return good;
    std::size_t target = 0;
    for (const JsonValue::Member& member : primitive.list("targets")) {
        if (auto good = all(&member.value, fmt::format("@{}", target++)); !good) return good;
    }
    return {};
}

}  // namespace lacedring::detail
