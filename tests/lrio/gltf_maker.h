#pragma once
// Small glTF documents for tests.

#include <fmt/format.h>

#include <cstdint>
#include <initializer_list>
#include <string>

#include "tests/lrio/mesh_files.h"

namespace lacedring::test {

/// Builds a glTF document with one buffer. Each accessor has a buffer view of its own.
class GltfMaker {
  public:
    template <class T>
    int add(int component_type, const char* type, std::initializer_list<T> values, int components,
            bool normalized = false) {
        add_view(packed(values), 0);
        return add_accessor(fmt::format(R"("bufferView":{},"componentType":{},"count":{},"type":"{}"{})", views_ - 1,
                                        component_type, values.size() / static_cast<std::size_t>(components), type,
                                        normalized ? R"(,"normalized":true)" : ""));
    }
    int floats(const char* type, std::initializer_list<float> values, int components) {
        return add(5126, type, values, components);
    }
    int add_accessor(const std::string& fields) {
        accessor_json_ += (accessors_ == 0 ? "{" : ",{") + fields + "}";
        return accessors_++;
    }
    int add_view(const std::string& bytes, int stride) {
        const std::size_t offset = append(bytes);
        return add_view_json(fmt::format(R"("buffer":0,"byteOffset":{},"byteLength":{}{})", offset, bytes.size(),
                                         stride == 0 ? "" : fmt::format(R"(,"byteStride":{})", stride)));
    }
    int add_view_json(const std::string& fields) {
        view_json_ += (views_ == 0 ? "{" : ",{") + fields + "}";
        return views_++;
    }
    /// Appends bytes to the buffer and returns their offset.
    std::size_t append(const std::string& bytes) {
        bin_.resize((bin_.size() + 3) / 4 * 4, '\0');
        const std::size_t offset = bin_.size();
        bin_ += bytes;
        return offset;
    }
    /// Adds further buffers, as JSON: ",{...}".
    void add_buffers(const std::string& json) { more_buffers_ += json; }
    /// `rest`: the other members of the document, as JSON.
    std::string glb_file(const std::string& rest) const { return glb(json(rest, ""), bin_); }
    std::string json(const std::string& rest, const std::string& uri) const {
        return fmt::format(
            R"({{"asset":{{"version":"2.0"}},"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}{}}}{}],{}}})",
            accessor_json_, view_json_, bin_.size(), uri.empty() ? "" : R"(,"uri":")" + uri + "\"", more_buffers_,
            rest);
    }
    const std::string& bin() const { return bin_; }

  private:
    std::string bin_;
    std::string accessor_json_;
    std::string view_json_;
    std::string more_buffers_;
    int accessors_ = 0;
    int views_ = 0;
};

inline const std::initializer_list<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::string one_node = R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)";

inline std::string mesh_of(const std::string& primitives, const std::string& before = "") {
    return before + R"("meshes":[{"primitives":[)" + primitives + "]}]";
}

}  // namespace lacedring::test
