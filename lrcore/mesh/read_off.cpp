// Object File Format, ascii: [ST][C][N]OFF, one vertex and one face a line.

#include <algorithm>
#include <cmath>

#include "lrcore/mesh/read_formats.h"
#include "lrcore/mesh/text_scanner.h"

namespace lr::detail {
namespace {

struct Header {
    bool known = false;
    bool texture = false;
    bool colour = false;
    bool normal = false;
    bool higher_dimension = false;
};

Header parse_header_word(std::string_view word) {
    Header header;
    const auto take = [&word](std::string_view prefix) {
        const bool found = word.starts_with(prefix);
        if (found) word.remove_prefix(prefix.size());
        return found;
    };
    header.texture = take("ST");
    header.colour = take("C");
    header.normal = take("N");
    const bool four = take("4");
    const bool any = take("n");
    header.higher_dimension = four || any;
    header.known = word == "OFF";
    return header;
}

class OffReader {
  public:
    explicit OffReader(std::string_view text) : scanner_(text, '#') {}

    Result<Mesh> read() {
        scanner_.skip_space();
        const TextScanner start = scanner_;
        header_ = parse_header_word(scanner_.word());
        if (!header_.known) {  // the word may be left out
            header_ = {};
            scanner_ = start;
        }
        if (header_.higher_dimension) return unsupported("OFF with more than 3 dimensions");
        std::string_view word = scanner_.next_word();
        if (word == "BINARY") return unsupported("binary OFF");

        std::uint64_t faces = 0;
        if (!parse_number(word, vertices_)) return not_number(word, "the number of vertices");
        word = scanner_.next_word();
        if (!parse_number(word, faces)) return not_number(word, "the number of faces");
        if (vertices_ > max_vertices) return too_many_vertices();
        // A vertex takes at least "0 0 0" and a line end, a face "3 0 0 0" (or "0"): never allocate for more.
        if (vertices_ > scanner_.remaining() / 6 + 1 || faces > scanner_.remaining() / 2 + 1) {
            return malformed("line {}: {} vertices and {} faces are more than the file has bytes for", scanner_.line(),
                             vertices_, faces);
        }
        scanner_.skip_line();  // the number of edges, which nobody needs
        if (auto good = read_vertices(); !good) return good.error();
        if (auto good = read_faces(faces); !good) return good.error();
        return build();
    }

  private:
    Error not_number(std::string_view word, std::string_view what) const {
        if (word.empty()) return malformed("line {}: ends before {}", scanner_.line(), what);
        return malformed("line {}: {} is not {}", scanner_.line(), shown(word), what);
    }

    Result<void> read_floats(std::size_t count, std::vector<float>& out) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view word = scanner_.next_word_of_line();
            float value = 0;
            if (!parse_number(word, value)) return not_number(word, "a number");
            out.push_back(value);
        }
        return {};
    }

    Result<void> read_vertices() {
        positions_.reserve(static_cast<std::size_t>(vertices_) * 3);
        for (std::uint64_t v = 0; v < vertices_; ++v, scanner_.skip_line()) {
            scanner_.skip_space();
            if (auto good = read_floats(3, positions_); !good) return good;
            if (!std::all_of(positions_.end() - 3, positions_.end(), [](float x) { return std::isfinite(x); })) {
                return malformed("line {}: vertex {} is not finite", scanner_.line(), v);
            }
            if (header_.normal) {
                if (auto good = read_floats(3, normals_); !good) return good;
            }
            if (header_.colour) {
                if (auto good = read_colour(v == 0); !good) return good;
            }
            if (header_.texture) {
                if (auto good = read_floats(2, textures_); !good) return good;
            }
        }
        return {};
    }

    /// Three or four numbers, as many as the first vertex has: 0 to 255, or fractions if any is written as one.
    Result<void> read_colour(bool first) {
        if (first) {
            TextScanner ahead = scanner_;
            std::size_t words = 0;
            while (!ahead.next_word_of_line().empty()) ++words;
            if (header_.texture) words -= std::min<std::size_t>(words, 2);
            if (words < 3) return malformed("line {}: {} numbers where a colour is due", scanner_.line(), words);
            colour_width_ = words > 3 ? 4 : 3;
        }
        for (std::size_t i = 0; i < colour_width_; ++i) {
            const std::string_view word = scanner_.next_word_of_line();
            float value = 0;
            if (!parse_number(word, value)) return not_number(word, "a colour");
            std::uint8_t byte = 0;
            colours_are_bytes_ = colours_are_bytes_ && parse_number(word, byte);
            colours_.push_back(value);
        }
        return {};
    }

    Result<void> read_faces(std::uint64_t faces) {
        // "3 0 0 0" and a line end: a triangle takes 8 bytes or more
        indices_.reserve(3 * std::min<std::size_t>(static_cast<std::size_t>(faces), scanner_.remaining() / 8 + 1));
        for (std::uint64_t f = 0; f < faces; ++f, scanner_.skip_line()) {
            std::string_view word = scanner_.next_word();
            std::uint64_t corners = 0;
            if (!parse_number(word, corners)) return not_number(word, "the number of corners of a face");
            Fan<std::uint32_t> fan;
            for (std::uint64_t i = 0; i < corners; ++i) {
                word = scanner_.next_word_of_line();
                std::int64_t index = 0;
                if (!parse_number(word, index)) return not_number(word, "an index");
                if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
                    return malformed("line {}: face {}: index {} is out of range ({} vertices)", scanner_.line(), f,
                                     index, vertices_);
                }
                fan.add(static_cast<std::uint32_t>(index), [this](std::uint32_t v) { indices_.push_back(v); });
            }
        }
        return {};
    }

    Result<Mesh> build() {
        Mesh mesh;
        mesh.vertex_count = static_cast<std::uint32_t>(vertices_);
        mesh.indices = std::move(indices_);
        mesh.attributes.push_back(float_attribute("POSITION", 3, positions_));
        if (header_.normal) mesh.attributes.push_back(float_attribute("NORMAL", 3, normals_));
        if (header_.texture) {
            mesh.attributes.push_back(float_attribute("TEXCOORD_0", 2, textures_));
            mesh.attributes.back().v_up = true;
        }
        if (header_.colour) {
            const auto width = static_cast<std::uint8_t>(colour_width_);
            Attribute colour = float_attribute("COLOR_0", width, colours_);
            if (colours_are_bytes_) {
                colour.type = ComponentType::u8;
                colour.normalized = true;
                colour.data.clear();
                for (const float c : colours_) colour.data.push_back(static_cast<std::byte>(static_cast<int>(c)));
            }
            mesh.attributes.push_back(std::move(colour));
        }
        return checked(std::move(mesh));
    }

    TextScanner scanner_;
    Header header_;
    std::uint64_t vertices_ = 0;
    std::vector<float> positions_;
    std::vector<float> normals_;
    std::vector<float> textures_;
    std::vector<float> colours_;
    std::size_t colour_width_ = 0;
    bool colours_are_bytes_ = true;
    std::vector<std::uint32_t> indices_;
};

}  // namespace

bool looks_like_off(std::string_view text) {
    TextScanner scanner(text, '#');
    scanner.skip_space();
    return parse_header_word(scanner.word()).known;
}

Result<Mesh> read_off(std::string_view text, [[maybe_unused]] Reading& reading) {
    return OffReader(text).read();
}

}  // namespace lr::detail
