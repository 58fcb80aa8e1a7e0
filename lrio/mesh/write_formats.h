#pragma once
// The writers of write_mesh. Each makes the whole file in memory. Internal to lrio.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring::detail {

using Bytes = std::vector<std::byte>;

inline void append(Bytes& to, std::span<const std::byte> bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}
inline void append(Bytes& to, std::string_view text) {
    append(to, std::as_bytes(std::span(text.data(), text.size())));
}

/// Makes names unique by appending a number to a name that is taken.
class UniqueNames {
  public:
    std::string take(const std::string& wanted) {
        if (used_.insert(wanted).second) return wanted;
        std::uint64_t& number = next_.try_emplace(wanted, 2).first->second;
        while (true) {  // each iteration skips a used name or returns: linear in all names
            std::string name = fmt::format("{}_{}", wanted, number++);
            if (used_.insert(name).second) return name;
        }
    }

  private:
    std::unordered_set<std::string> used_;
    std::unordered_map<std::string, std::uint64_t> next_;
};

/// A mesh's attributes converted for glTF.
struct GltfAttributes {
    std::vector<Attribute> attributes;  ///< with unique UTF-8 names, and types that glTF allows for them
    bool quantized = false;             ///< some attribute needs KHR_mesh_quantization
};
/// Converts the mesh's attributes. Errors: invalid_argument (a position that is not finite as a float).
Result<GltfAttributes> fit_to_gltf(const Mesh& mesh, WriteNotes& notes);

// The file is `head` followed by `body`.
Result<void> make_glb(const Mesh& mesh, Bytes& head, Bytes& body, WriteNotes& notes);
void make_ply(const Mesh& mesh, Bytes& head, Bytes& body);
void make_obj(const Mesh& mesh, Bytes& body, WriteNotes& notes);

}  // namespace lacedring::detail
