#pragma once
// The readers of read_mesh and their shared helpers. Internal to lrio.

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lacedring/base.hpp"
#include "lacedring/materials.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/mesh_files.hpp"
#include "lacedring/primitives.hpp"

namespace lacedring::detail {

static_assert(std::endian::native == std::endian::little, "Mesh holds little-endian bits, and so do most files");

/// The inputs and outputs of one call of read_mesh, apart from the mesh.
struct Reading {
    const ReadOptions& options;
    ReadReport& report;
    std::filesystem::path name;      ///< of the file; empty: unnamed
    Materials* materials = nullptr;  ///< receives a glTF's materials; null: not wanted

    /// Adds "COUNT one" or "COUNT many" to the report's left_out, unless `count` is 0.
    void leave_out(std::uint64_t count, std::string_view one, std::string_view many);
    /// Checks that a mesh with vertices of `stride` bytes, read from a file of `file_bytes`, is within the memory
    /// limit. Takes doubles, since a hostile file's counts would overflow integers. Errors: memory_limit.
    Result<void> check_memory(double vertices, double stride, double triangles, double file_bytes) const;
};

// Each reader gets the whole file, throws only if memory runs out, and returns a mesh that `checked` accepted.
Result<Mesh> read_gltf(std::span<const std::byte> bytes, Reading& reading);
Result<PrimitiveList> read_gltf_primitives(std::span<const std::byte> bytes, Reading& reading);
Result<Mesh> read_obj(std::string_view text, Reading& reading);
Result<Mesh> read_off(std::string_view text, Reading& reading);
Result<Mesh> read_ply(std::string_view bytes, Reading& reading);
Result<Mesh> read_stl(std::string_view bytes, Reading& reading);

/// Does the text start, after white space and # comments, with one of OFF's header words?
bool looks_like_off(std::string_view text);

/// Is it binary STL by its length, or ascii STL by its first word, which may follow a byte-order mark?
bool looks_like_stl(std::string_view bytes);

/// Checks that the mesh has triangles and that its positions (attributes[0]) are finite as floats. Errors: malformed.
Result<Mesh> checked(Mesh mesh);

/// The largest number of vertices: UINT32_MAX is never an index, and means "none".
inline constexpr std::uint64_t max_vertices = UINT32_MAX - 1;

template <class... Args>
Error malformed(fmt::format_string<Args...> format, Args&&... args) {
    return {ErrorCode::malformed, fmt::format(format, std::forward<Args>(args)...)};
}

template <class... Args>
Error unsupported(fmt::format_string<Args...> format, Args&&... args) {
    return {ErrorCode::unsupported, fmt::format(format, std::forward<Args>(args)...)};
}

inline Error too_many_vertices() {
    return {ErrorCode::too_large, "has more than 2^32 - 2 vertices"};
}

/// Quotes a piece of the file for an error message: short, on one line, printable.
std::string shown(std::string_view text);

/// The first 8 names, each by shown(), separated by commas, and the number of further names.
std::string shown_names(std::span<const std::string> names);

/// A vertex attribute of floats.
Attribute float_attribute(std::string name, std::uint8_t components, std::span<const float> values);

/// Calls read() and converts exceptions to errors: memory may run out, and tinygltf's exceptions are not documented.
template <class Read>
auto caught(const Read& read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::too_large, "does not fit into memory"};
    } catch (const std::length_error&) {
        return Error{ErrorCode::too_large, "does not fit into memory"};
    } catch (const std::exception& exception) {
        return malformed("cannot be read: {}", shown(exception.what()));
    } catch (...) {
        return malformed("cannot be read");
    }
}

/// Converts a polygon, given corner by corner, to a fan around its first corner: calls emit(a, b, c) for each triangle.
template <class Corner>
class Fan {
  public:
    template <class Emit>
    void add(const Corner& corner, const Emit& emit) {
        if (count_ >= 2) emit(first_, previous_, corner);
        if (count_ == 0) first_ = corner;
        previous_ = corner;
        ++count_;
    }

  private:
    Corner first_{};
    Corner previous_{};
    std::size_t count_ = 0;
};

/// Converts a strip, given vertex by vertex, to triangles. Swaps two corners of every second triangle to keep the
/// orientation, as OpenGL and glTF define it.
class Strip {
  public:
    void add(std::uint32_t vertex, std::vector<std::uint32_t>& indices) {
        if (count_ >= 2) {
            const bool odd = (count_ & 1U) != 0;
            indices.insert(indices.end(), {before_, odd ? vertex : previous_, odd ? previous_ : vertex});
        }
        before_ = previous_;
        previous_ = vertex;
        ++count_;
    }
    void restart() { count_ = 0; }

  private:
    std::uint32_t before_ = 0;
    std::uint32_t previous_ = 0;
    std::size_t count_ = 0;
};

}  // namespace lacedring::detail
