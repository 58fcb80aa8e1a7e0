#pragma once
// The writers behind write_mesh: each makes the whole file in memory. Internal to lrcore/mesh.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "lrcore/base/result.h"
#include "lrcore/mesh/mesh.h"

namespace lr::detail {

using Bytes = std::vector<std::byte>;

inline void append(Bytes& to, std::span<const std::byte> bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}
inline void append(Bytes& to, std::string_view text) {
    append(to, std::as_bytes(std::span(text.data(), text.size())));
}

// The file is `head` and then `body`.
Result<void> make_glb(const Mesh& mesh, Bytes& head, Bytes& body);
void make_ply(const Mesh& mesh, Bytes& head, Bytes& body);
void make_obj(const Mesh& mesh, Bytes& body);

}  // namespace lr::detail
