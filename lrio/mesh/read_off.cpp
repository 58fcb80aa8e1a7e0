// Reads ascii OFF (Object File Format): a header word, OFF with the optional prefixes ST, C and N; vertices; faces.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "lrcore/base/try.h"
#include "lrio/mesh/polygon.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/text_scanner.h"

namespace lacedring::detail {
namespace {

struct Header {
    std::size_t length = 0;  ///< of the header word; 0: there is no header word
    bool texture = false;
    bool color = false;
    bool normal = false;
    bool normal_before_color = false;  ///< the prefix N comes before C; says nothing about the order of the values
    bool higher_dimension = false;
};

/// Accepts prefixes in any order, and the number of vertices directly after the word.
Header parse_header(std::string_view text) {
    Header header;
    bool smooth = false, four = false, any = false;
    std::string_view rest = text;
    const auto take = [&rest](std::string_view prefix, bool& flag) {
        if (flag || !rest.starts_with(prefix)) return false;
        rest.remove_prefix(prefix.size());
        return flag = true;
    };
    while (!rest.starts_with("OFF")) {
        if (take("ST", header.texture) || take("C", header.color) || take("S", smooth) || take("4", four) ||
            take("n", any)) {
            continue;
        }
        if (!take("N", header.normal)) return {};
        header.normal_before_color = !header.color;
    }
    rest.remove_prefix(3);
    if (!rest.empty() && !TextScanner::is_space(rest[0]) && rest[0] != '#' && (rest[0] < '0' || rest[0] > '9'))
        return {};
    header.normal_before_color = header.normal_before_color && header.color;
    header.higher_dimension = four || any;
    header.length = text.size() - rest.size();
    return header;
}

Header header_at(const TextScanner& scanner) {
    return parse_header({scanner.position(), scanner.remaining()});
}

class OffReader {
  public:
    explicit OffReader(std::string_view text) : scanner_(text, true) {}

    Result<Mesh> read(Reading& reading) {
        scanner_.skip_space();
        header_ = header_at(scanner_);  // the word is optional
        scanner_.skip_bytes(header_.length);
        if (header_.higher_dimension) return unsupported("OFF with more than 3 dimensions");
        LR_TRY(read_counts());
        LR_TRY(read_elements());
        scanner_.skip_space();
        reading.leave_out(scanner_.remaining(), "byte after the last face", "bytes after the last face");
        return build(reading);
    }

  private:
    Error not_number(std::string_view word, std::string_view what) {
        ended_early_ = word.empty();
        if (ended_early_) return malformed("line {}: ends before {}", scanner_.line(), what);
        return malformed("line {}: {} is not {}", scanner_.line(), shown(word), what);
    }

    Result<void> read_counts() {
        std::string_view word = scanner_.next_word();
        if (word == "BINARY") return unsupported("binary OFF");
        if (!parse_number(word, vertices_)) return not_number(word, "the number of vertices");
        word = scanner_.next_word_of_line();
        const bool one_line = !word.empty();
        if (!one_line) word = scanner_.next_word();
        if (!parse_number(word, faces_)) return not_number(word, "the number of faces");
        if (vertices_ > max_vertices) return too_many_vertices();
        // Limits allocations: a vertex takes at least 6 bytes ("0 0 0" and a line end), a face 2 ("0" and a line end).
        if (vertices_ > scanner_.remaining() / 6 + 1 || faces_ > scanner_.remaining() / 2 + 1) {
            return malformed("line {}: {} vertices and {} faces are more than the file has bytes for", scanner_.line(),
                             vertices_, faces_);
        }
        // Skips the number of edges, which is not needed and missing in some files.
        if (!one_line && scanner_.skip_to_line_end()) scanner_.next_word();
        scanner_.skip_line();
        return {};
    }

    /// Reads one vertex per line, as nearly all files have them. If a line is too short, ignores line ends.
    Result<void> read_elements() {
        const TextScanner start = scanner_;
        by_line_ = true;
        color_width_ = header_.color ? 3 : 0;
        auto good = read_vertices_and_faces();
        if (good || !ended_early_) return good;
        by_line_ = false;
        for (const std::size_t width : {std::size_t{4}, std::size_t{3}}) {
            if (width == 3 && !header_.color) break;
            scanner_ = start;
            color_width_ = header_.color ? width : 0;
            if (read_vertices_and_faces()) return {};
        }
        return good;
    }

    Result<void> read_vertices_and_faces() {
        ended_early_ = false;
        longer_ = face_colors_ = 0;
        polygons_ = {};
        for (std::vector<float>* list : {&positions_, &others_, &textures_}) list->clear();
        indices_.clear();
        if (auto good = read_vertices(); !good) return good;
        if (!by_line_ && !scanner_.skip_to_line_end()) return malformed("a vertex ends within a line");
        if (auto good = read_faces(); !good) return good;
        if (by_line_) return {};
        scanner_.skip_space();
        if (!scanner_.at_end()) return malformed("something follows the faces");
        return {};
    }

    Result<void> read_floats(std::size_t count, std::vector<float>& out) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view word = by_line_ ? scanner_.next_word_of_line() : scanner_.next_word();
            float value = 0;
            if (!parse_number(word, value)) return not_number(word, "a number");
            out.push_back(value);
        }
        return {};
    }

    Result<void> read_vertices() {
        positions_.reserve(static_cast<std::size_t>(vertices_) * 3);
        for (std::uint64_t v = 0; v < vertices_; ++v) {
            scanner_.skip_space();
            if (auto good = read_floats(3, positions_); !good) return good;
            if (!std::all_of(positions_.end() - 3, positions_.end(), [](float x) { return std::isfinite(x); })) {
                return malformed("line {}: vertex {} is not finite", scanner_.line(), v);
            }
            if (v == 0 && by_line_ && header_.color) {
                if (auto good = find_color_width(); !good) return good;
            }
            if (auto good = read_floats((header_.normal ? 3 : 0) + color_width_, others_); !good) return good;
            if (header_.texture) {
                if (auto good = read_floats(2, textures_); !good) return good;
            }
            if (!by_line_) continue;
            if (!scanner_.skip_to_line_end()) ++longer_;
            scanner_.skip_line();
        }
        return {};
    }

    /// Sets color_width_ to 3 or 4, by the first vertex.
    Result<void> find_color_width() {
        TextScanner ahead = scanner_;
        std::size_t words = 0;
        while (!ahead.next_word_of_line().empty()) ++words;
        words -= std::min<std::size_t>(words, (header_.normal ? 3 : 0) + (header_.texture ? 2 : 0));
        ended_early_ = words < 3;
        if (words < 3) return malformed("line {}: {} numbers where a color is due", scanner_.line(), words);
        color_width_ = words > 3 ? 4 : 3;
        return {};
    }

    /// A face begins on a new line. Its indices may continue on the next lines; the rest of the line is its color.
    Result<void> read_faces() {
        // A triangle takes at least 8 bytes: "3 0 0 0" and a line end.
        indices_.reserve(3 * std::min<std::size_t>(static_cast<std::size_t>(faces_), scanner_.remaining() / 8 + 1));
        for (std::uint64_t f = 0; f < faces_; ++f, scanner_.skip_line()) {
            std::string_view word = scanner_.next_word();
            std::uint64_t corners = 0;
            if (!parse_number(word, corners)) return not_number(word, "the number of corners of a face");
            Fan<std::uint32_t> fan;
            for (std::uint64_t i = 0; i < corners; ++i) {
                word = scanner_.next_word_of_line();
                if (word.empty()) word = scanner_.next_word();
                std::int64_t index = 0;
                if (!parse_number(word, index)) return not_number(word, "an index");
                if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
                    return malformed("line {}: face {}: index {} is out of range ({} vertices)", scanner_.line(), f,
                                     index, vertices_);
                }
                fan.add(static_cast<std::uint32_t>(index), [this](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                    indices_.insert(indices_.end(), {a, b, c});
                });
            }
            polygons_.add(corners);
            if (!scanner_.skip_to_line_end()) ++face_colors_;
        }
        return {};
    }

    /// Do colors come before normals? In Geomview's format they never do, whatever the order of the header's prefixes.
    /// But MeshLab writes NCOFF with four color bytes and then a unit normal.
    bool colors_come_first() const {
        if (!header_.normal_before_color || color_width_ != 4) return false;
        for (std::size_t i = 0; i < others_.size(); i += 7) {
            const float* seven = others_.data() + i;
            if (!std::all_of(seven, seven + 4, is_byte)) return false;
            if (!std::all_of(seven + 4, seven + 7, [](float x) { return std::abs(x) <= 1; })) return false;
        }
        return true;
    }

    static bool is_byte(float x) { return x >= 0 && x <= 255 && x == std::floor(x); }

    static std::vector<float> columns(const std::vector<float>& table, std::size_t width, std::size_t first,
                                      std::size_t count) {
        std::vector<float> out;
        out.reserve(table.size() / width * count);
        for (std::size_t row = 0; row + width <= table.size(); row += width) {
            const auto from = table.begin() + static_cast<std::ptrdiff_t>(row + first);
            out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(count));
        }
        return out;
    }

    void add_normals_and_colors(Mesh& mesh) {
        const std::size_t normals = header_.normal ? 3 : 0, width = normals + color_width_;
        const bool colors_first = colors_come_first();
        if (header_.normal) {
            const std::size_t first = colors_first ? color_width_ : 0;
            mesh.attributes.push_back(float_attribute("NORMAL", 3, columns(others_, width, first, 3)));
        }
        if (header_.texture) {
            mesh.attributes.push_back(float_attribute("TEXCOORD_0", 2, textures_));
            mesh.attributes.back().v_up = true;
        }
        if (!header_.color) return;
        const std::vector<float> colors = columns(others_, width, colors_first ? 0 : normals, color_width_);
        Attribute color = float_attribute("COLOR_0", static_cast<std::uint8_t>(color_width_), colors);
        // If no number is above 1, the range is 0 to 1, even if all are whole: "1 0 0 1" is red.
        if (std::all_of(colors.begin(), colors.end(), is_byte) &&
            std::any_of(colors.begin(), colors.end(), [](float x) { return x > 1; })) {
            color.type = ComponentType::u8;
            color.normalized = true;
            color.data.clear();
            for (const float c : colors) color.data.push_back(static_cast<std::byte>(static_cast<int>(c)));
        }
        mesh.attributes.push_back(std::move(color));
    }

    Result<Mesh> build(Reading& reading) {
        reading.leave_out(longer_, "vertex with numbers after its own", "vertices with numbers after their own");
        reading.leave_out(face_colors_, "color of a face", "colors of faces");
        polygons_.cut({std::as_bytes(std::span(positions_)).data(), false}, {&indices_}, reading);
        Mesh mesh;
        mesh.vertex_count = static_cast<std::uint32_t>(vertices_);
        mesh.indices = std::move(indices_);
        mesh.attributes.push_back(float_attribute("POSITION", 3, positions_));
        add_normals_and_colors(mesh);
        return checked(std::move(mesh));
    }

    TextScanner scanner_;
    Header header_;
    std::uint64_t vertices_ = 0;
    std::uint64_t faces_ = 0;
    bool by_line_ = true;
    bool ended_early_ = false;  // the last error was a missing word
    std::vector<float> positions_;
    std::vector<float> others_;  // the normal and the color of each vertex
    std::vector<float> textures_;
    std::size_t color_width_ = 0;
    std::vector<std::uint32_t> indices_;
    PolygonList polygons_;
    std::uint64_t longer_ = 0;  // number of vertices whose line has surplus numbers
    std::uint64_t face_colors_ = 0;
};

}  // namespace

bool looks_like_off(std::string_view text) {
    TextScanner scanner(text, true);
    scanner.skip_space();
    return header_at(scanner).length != 0;
}

Result<Mesh> read_off(std::string_view text, Reading& reading) {
    return OffReader(text).read(reading);
}

}  // namespace lacedring::detail
