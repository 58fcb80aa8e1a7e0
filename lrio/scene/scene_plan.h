#pragma once
// What of a glTF scene is compressed: its triangle primitives, by the vertices that they share. Internal to lrio.

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

/// An index list, and the primitives that have it.
struct ScenePart {
    std::optional<std::uint32_t> indices;  ///< accessor; none: the vertices in their order
    int mode = 4;                          ///< triangles, strip or fan
    std::vector<PrimitivePlace> primitives;
};

struct SceneAttribute {
    std::uint32_t accessor = 0;
    /// As in the stream: glTF's, with "@T" behind it in morph target T, and "#N" for the N-th accessor of one name.
    std::string name;
};

/// Vertices that primitives share: all accessors that are connected by primitives that use both, as attributes, morph
/// targets or indices. All have as many elements.
struct VertexSet {
    std::size_t vertices = 0;
    std::vector<SceneAttribute> attributes;  ///< the first one is POSITION
    std::vector<ScenePart> parts;
    bool keep_order = false;  ///< something else reads the vertices, or the primitives, by their numbers
};

struct ScenePlan {
    std::vector<VertexSet> sets;
    std::map<std::string, std::size_t> not_compressed;  ///< primitives by what they are
};

/// Reads no values, but looks at where they lie. Errors: malformed (primitives that are not as glTF has them).
Result<ScenePlan> plan_scene(const JsonValue& document, GltfFile& file, bool keep_order);

/// Calls visit(name, accessor) for each attribute of a primitive, those of morph targets as "NAME@TARGET". What visit
/// returns, if it is an error, ends it. Errors: malformed (a number that is none).
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
