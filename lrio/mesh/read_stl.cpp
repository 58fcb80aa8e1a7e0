// Reads STL. Its triangles share no vertices, so vertices at the same position are merged.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "lrcore/base/try.h"
#include "lrio/mesh/distinct.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/text_scanner.h"

namespace lacedring::detail {
namespace {

constexpr std::size_t header_bytes = 84;  // 80 free bytes and the number of triangles
constexpr std::size_t triangle_bytes = 50;
constexpr std::size_t normal_bytes = 12;

bool equals_ignoring_case(std::string_view word, std::string_view lower) {
    return word.size() == lower.size() && std::equal(word.begin(), word.end(), lower.begin(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == b;
           });
}

std::uint64_t claimed_triangles(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + header_bytes - 4, 4);
    return count;
}

bool has_binary_length(std::string_view bytes) {
    return bytes.size() >= header_bytes && bytes.size() == header_bytes + triangle_bytes * claimed_triangles(bytes);
}

bool is_ascii(std::string_view bytes) {
    // Binary files may begin with "solid", too, but their headers and floats contain control characters.
    if (has_binary_length(bytes)) return false;
    const std::string_view head = without_byte_order_mark(bytes).substr(0, 512);
    return equals_ignoring_case(TextScanner(head).next_word(), "solid") &&
           std::none_of(head.begin(), head.end(), [](char c) { return c >= '\0' && c < '\t'; });
}

Result<Mesh> merged(const std::vector<float>& corners) {
    const std::size_t count = corners.size() / 3;
    if (count > max_vertices) return Error{ErrorCode::too_large, "has more than 2^32 - 2 triangle corners"};
    const auto* data = reinterpret_cast<const std::byte*>(corners.data());
    // -0 equals 0. A vertex keeps the bits of its first corner.
    std::vector<float> places;
    if (std::any_of(corners.begin(), corners.end(), [](float x) { return x == 0 && std::signbit(x); })) {
        places.reserve(corners.size());
        for (const float x : corners) places.push_back(x == 0 ? 0.0F : x);
    }
    Groups groups = group_equal_bytes(places.empty() ? data : reinterpret_cast<const std::byte*>(places.data()),
                                      3 * sizeof(float), static_cast<std::uint32_t>(count));
    Mesh mesh;
    mesh.vertex_count = groups.count;
    Attribute position{"POSITION", ComponentType::f32, 3, false, {}};
    position.data.reserve(std::size_t{groups.count} * 3 * sizeof(float));
    for (const std::uint32_t corner : groups.first_items()) {
        const std::byte* from = data + corner * (3 * sizeof(float));
        position.data.insert(position.data.end(), from, from + 3 * sizeof(float));
    }
    mesh.attributes.push_back(std::move(position));
    mesh.indices = std::move(groups.of);
    return checked(std::move(mesh));
}

Result<Mesh> read_binary(std::string_view bytes, Reading& reading) {
    if (bytes.size() < header_bytes) return malformed("{} bytes are too few for an STL file", bytes.size());
    const std::uint64_t claimed = claimed_triangles(bytes);
    const std::uint64_t present = (bytes.size() - header_bytes) / triangle_bytes;
    if (claimed > present) {
        return malformed("byte 80: {} triangles, but there are bytes for {}", claimed, present);
    }
    std::vector<float> corners(static_cast<std::size_t>(claimed) * 9);
    std::uint64_t attributes = 0;  // triangles whose two attribute bytes are not 0: some programs store colors there
    for (std::size_t t = 0; t < claimed; ++t) {
        float* nine = corners.data() + t * 9;
        std::memcpy(nine, bytes.data() + header_bytes + t * triangle_bytes + normal_bytes, 9 * sizeof(float));
        for (std::size_t i = 0; i < 9; ++i) {
            if (!std::isfinite(nine[i])) return malformed("triangle {}: vertex {} is not finite", t, i / 3);
        }
        const char* end = bytes.data() + header_bytes + (t + 1) * triangle_bytes;
        attributes += end[-1] != 0 || end[-2] != 0 ? 1 : 0;
    }
    reading.leave_out(attributes, "color or attribute of a triangle", "colors or attributes of triangles");
    reading.leave_out(bytes.size() - header_bytes - static_cast<std::size_t>(claimed) * triangle_bytes,
                      "byte after the last triangle", "bytes after the last triangle");
    return merged(corners);
}

class AsciiStl {
  public:
    explicit AsciiStl(std::string_view text) : scanner_(text) {}

    Result<Mesh> read() {
        while (true) {  // a file may have several solids
            scanner_.skip_space();
            if (scanner_.at_end()) break;
            if (!is_next("solid")) return unexpected("'solid'");
            scanner_.skip_line();  // its name
            LR_TRY(read_solid());
        }
        return merged(corners_);
    }

  private:
    bool is_next(std::string_view keyword) {
        word_ = scanner_.next_word();
        return equals_ignoring_case(word_, keyword);
    }

    Error unexpected(std::string_view wanted) const {
        if (word_.empty()) return malformed("line {}: ends where {} is due", scanner_.line(), wanted);
        return malformed("line {}: {} where {} is due", scanner_.line(), shown(word_), wanted);
    }

    Result<void> read_solid() {
        while (is_next("facet")) {
            if (!is_next("normal")) return unexpected("'normal'");
            for (int i = 0; i < 3; ++i) {  // ignored: the vertices imply the normal, and the file's is often wrong
                float ignored = 0;
                word_ = scanner_.next_word();
                if (!parse_number(word_, ignored)) return unexpected("a number");
            }
            if (!is_next("outer")) return unexpected("'outer'");
            if (!is_next("loop")) return unexpected("'loop'");
            for (int i = 0; i < 3; ++i) {
                if (!is_next("vertex")) return unexpected("'vertex'");
                if (auto vertex = read_vertex(); !vertex) return vertex;
            }
            if (!is_next("endloop")) return unexpected("'endloop'");
            if (!is_next("endfacet")) return unexpected("'endfacet'");
        }
        if (!equals_ignoring_case(word_, "endsolid")) return unexpected("'facet' or 'endsolid'");
        scanner_.skip_line();
        return {};
    }

    Result<void> read_vertex() {
        for (int i = 0; i < 3; ++i) {
            float value = 0;
            word_ = scanner_.next_word();
            if (!parse_number(word_, value)) return unexpected("a number");
            if (!std::isfinite(value)) {
                const std::size_t corner = corners_.size() / 3;
                return malformed("line {}: triangle {}: vertex {} is not finite", scanner_.line(), corner / 3,
                                 corner % 3);
            }
            corners_.push_back(value);
        }
        return {};
    }

    TextScanner scanner_;
    std::string_view word_;
    std::vector<float> corners_;
};

}  // namespace

bool looks_like_stl(std::string_view bytes) {
    return has_binary_length(bytes) || is_ascii(bytes);
}

Result<Mesh> read_stl(std::string_view bytes, Reading& reading) {
    return is_ascii(bytes) ? AsciiStl(without_byte_order_mark(bytes)).read() : read_binary(bytes, reading);
}

}  // namespace lacedring::detail
