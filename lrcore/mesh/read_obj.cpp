// Wavefront OBJ: v, vt, vn and f. A vertex is a distinct v/vt/vn, as renderers see it.

#include <algorithm>
#include <cmath>

#include "lrcore/mesh/distinct.h"
#include "lrcore/mesh/read_formats.h"
#include "lrcore/mesh/text_scanner.h"

namespace lr::detail {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

/// One of the lists v, vt and vn, and how the corners of the faces refer to it.
struct List {
    std::string_view name;
    std::size_t width;                   // floats an entry
    std::vector<float> values;           // width floats an entry
    std::vector<std::uint32_t> corners;  // an entry for each corner of the triangles; empty while no corner has one
    std::uint64_t highest = 0;           // 1 + the highest entry referred to: faces may come before what they use
    const char* highest_place = nullptr;

    std::size_t size() const { return values.size() / width; }
    bool used() const { return !corners.empty(); }
};

struct Corner {
    std::uint32_t v = none;
    std::uint32_t vt = none;
    std::uint32_t vn = none;
};

class ObjReader {
  public:
    explicit ObjReader(std::string_view text) : scanner_(text, '#', true) {}

    Result<Mesh> read() {
        for (; !scanner_.at_end(); scanner_.skip_line()) {
            const std::string_view keyword = scanner_.next_word_of_line();
            Result<void> good;
            if (keyword == "v") {
                good = read_vertex();
            } else if (keyword == "vt") {
                good = read_numbers(textures_, 1);
            } else if (keyword == "vn") {
                good = read_numbers(normals_, 3);
            } else if (keyword == "f") {
                good = read_face();
            }
            if (!good) return good.error();
        }
        for (const List* list : {&vertices_, &textures_, &normals_}) {
            if (list->highest > list->size()) {
                return malformed("line {}: {} {} does not exist (there are {})", scanner_.line_of(list->highest_place),
                                 list->name, list->highest, list->size());
            }
        }
        return build();
    }

  private:
    template <class... Args>
    Error at_line(fmt::format_string<Args...> format, Args&&... args) const {
        return malformed("line {}: {}", scanner_.line(), fmt::format(format, std::forward<Args>(args)...));
    }

    /// The numbers of the line, at most `most` of them. Their count, or an error.
    Result<std::size_t> read_line(float* out, std::size_t least, std::size_t most) {
        std::size_t count = 0;
        for (; count < most; ++count) {
            const std::string_view word = scanner_.next_word_of_line();
            if (word.empty()) break;
            if (!parse_number(word, out[count])) return at_line("{} is not a number", shown(word));
        }
        if (count < least) return at_line("{} numbers where {} are due", count, least);
        return count;
    }

    Result<void> read_vertex() {
        float numbers[7] = {};
        const auto count = read_line(numbers, 3, 7);
        if (!count) return count.error();
        if (!std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || !std::isfinite(numbers[2])) {
            return at_line("vertex {} is not finite", vertices_.size() + 1);
        }
        if (vertices_.size() == max_vertices) return too_many_vertices();
        // x y z [w], or x y z r g b; colours are dropped unless every vertex has one.
        if (*count >= 6 && colours_.size() == vertices_.values.size()) {
            colours_.insert(colours_.end(), numbers + 3, numbers + 6);
        }
        vertices_.values.insert(vertices_.values.end(), numbers, numbers + 3);
        return {};
    }

    Result<void> read_numbers(List& list, std::size_t least) {
        float numbers[3] = {};
        if (const auto count = read_line(numbers, least, list.width); !count) return count.error();
        if (list.size() == max_vertices) return too_many_vertices();
        list.values.insert(list.values.end(), numbers, numbers + list.width);
        return {};
    }

    Result<void> read_face() {
        Fan<Corner> fan;
        while (true) {
            const std::string_view word = scanner_.next_word_of_line();
            if (word.empty()) return {};
            // v, v/vt, v//vn, v/vt/vn; some programs leave a slash behind with nothing after it
            const std::size_t slash = std::min(word.find('/'), word.size());
            std::string_view vt = word.substr(std::min(slash + 1, word.size()));
            const std::size_t second = std::min(vt.find('/'), vt.size());
            const std::string_view vn = vt.substr(std::min(second + 1, vt.size()));
            vt = vt.substr(0, second);
            Corner corner;
            const bool good = resolve(vertices_, word.substr(0, slash), corner.v) &&
                              (vt.empty() || resolve(textures_, vt, corner.vt)) &&
                              (vn.empty() || resolve(normals_, vn, corner.vn));
            if (!good) return at_line("{} is not a corner of a face", shown(word));
            if (corner.vt != none) start_using(textures_);
            if (corner.vn != none) start_using(normals_);
            fan.add(corner, [this](const Corner& c) {
                vertices_.corners.push_back(c.v);
                if (textures_used_) textures_.corners.push_back(c.vt);
                if (normals_used_) normals_.corners.push_back(c.vn);
            });
        }
    }

    /// Counts from 1, or from the end of the list so far if negative.
    bool resolve(List& list, std::string_view word, std::uint32_t& out) const {
        std::int64_t number = 0;
        if (!parse_number(word, number) || number == 0) return false;
        if (number < 0) number += static_cast<std::int64_t>(list.size()) + 1;
        if (number <= 0 || static_cast<std::uint64_t>(number) > max_vertices) return false;
        const auto one_based = static_cast<std::uint64_t>(number);
        if (one_based > list.highest) {
            list.highest = one_based;
            list.highest_place = word.data();
        }
        out = static_cast<std::uint32_t>(one_based - 1);
        return true;
    }

    void start_using(List& list) {
        bool& used = &list == &textures_ ? textures_used_ : normals_used_;
        if (used) return;
        used = true;
        list.corners.assign(vertices_.corners.size(), none);
    }

    Result<Mesh> build() {
        if (vertices_.corners.empty()) return malformed("has no triangles");
        Mesh mesh;
        // vertex -> entry of each list; without vt and vn the list of v is the list of vertices, unused ones included
        std::vector<std::uint32_t> v;
        std::vector<std::uint32_t> vt;
        std::vector<std::uint32_t> vn;
        if (!textures_.used() && !normals_.used()) {
            mesh.vertex_count = static_cast<std::uint32_t>(vertices_.size());
            mesh.indices = std::move(vertices_.corners);
            mesh.attributes.push_back(float_attribute("POSITION", 3, vertices_.values));
        } else {
            if (vertices_.corners.size() > max_vertices) return too_many_vertices();
            const Groups groups = group_corners();
            for (const std::uint32_t corner : groups.first_items()) {
                v.push_back(vertices_.corners[corner]);
                if (textures_.used()) vt.push_back(textures_.corners[corner]);
                if (normals_.used()) vn.push_back(normals_.corners[corner]);
            }
            append_unused(v);
            if (v.size() > max_vertices) return too_many_vertices();
            mesh.vertex_count = static_cast<std::uint32_t>(v.size());
            mesh.indices = groups.of;
            mesh.attributes.push_back(gather("POSITION", vertices_, v));
            vt.resize(v.size(), none);
            vn.resize(v.size(), none);
            if (normals_.used()) mesh.attributes.push_back(gather("NORMAL", normals_, vn));
            if (textures_.used()) {
                mesh.attributes.push_back(gather("TEXCOORD_0", textures_, vt));
                mesh.attributes.back().v_up = true;
            }
        }
        if (!colours_.empty() && colours_.size() == vertices_.values.size()) {
            List colours{"colour", 3, std::move(colours_), {}};
            mesh.attributes.push_back(v.empty() ? float_attribute("COLOR_0", 3, colours.values)
                                                : gather("COLOR_0", colours, v));
        }
        return checked(std::move(mesh));
    }

    Groups group_corners() const {
        const auto entry = [](const List& list, std::uint32_t i) { return list.used() ? list.corners[i] : none; };
        return group_equal(
            static_cast<std::uint32_t>(vertices_.corners.size()),
            [&](std::uint32_t i) {
                const std::uint64_t high = std::uint64_t{entry(textures_, i)} << 32U;
                return mix(mix(0, high | vertices_.corners[i]), entry(normals_, i));
            },
            [&](std::uint32_t i, std::uint32_t j) {
                for (const List* list : {&vertices_, &textures_, &normals_}) {
                    const std::uint32_t a = entry(*list, i), b = entry(*list, j);
                    if (a != b) return a < b ? -1 : 1;
                }
                return 0;
            });
    }

    /// Every v that no face uses becomes a vertex at the end, so that nothing of the file is lost.
    void append_unused(std::vector<std::uint32_t>& v) const {
        std::vector<bool> used(vertices_.size(), false);
        for (const std::uint32_t i : v) used[i] = true;
        for (std::uint32_t i = 0; i < used.size(); ++i) {
            if (!used[i]) v.push_back(i);
        }
    }

    static Attribute gather(std::string name, const List& list, std::span<const std::uint32_t> entries) {
        std::vector<float> values(entries.size() * list.width, 0.0F);
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (entries[i] == none) continue;
            std::copy_n(list.values.data() + entries[i] * list.width, list.width, values.data() + i * list.width);
        }
        return float_attribute(std::move(name), static_cast<std::uint8_t>(list.width), values);
    }

    TextScanner scanner_;
    List vertices_{"vertex", 3, {}, {}};
    List textures_{"texture coordinate", 2, {}, {}};
    List normals_{"normal", 3, {}, {}};
    bool textures_used_ = false;  // List::used() cannot tell before the first triangle is complete
    bool normals_used_ = false;
    std::vector<float> colours_;
};

}  // namespace

Result<Mesh> read_obj(std::string_view text, [[maybe_unused]] Reading& reading) {
    return ObjReader(text).read();
}

}  // namespace lr::detail
