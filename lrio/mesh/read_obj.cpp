// Reads Wavefront OBJ: v, vt, vn and f. A mesh vertex is a distinct triple v/vt/vn. Other statements are counted and
// left out.

#include <algorithm>
#include <array>
#include <cmath>

#include "lrcore/base/try.h"
#include "lrio/mesh/distinct.h"
#include "lrio/mesh/polygon.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/text_scanner.h"

namespace lacedring::detail {
namespace {

constexpr std::uint32_t absent = UINT32_MAX;

/// One of the lists v, vt and vn, and the references of face corners to it.
struct List {
    std::string_view name;
    std::size_t width;                   // floats of an entry
    std::vector<float> values;           // `width` floats an entry
    std::vector<std::uint32_t> corners;  // the entry of each triangle corner; empty while no corner has one
    std::uint64_t references = 0;        // number of references from face corners
    std::uint64_t highest = 0;           // 1 + highest referenced entry, which may follow the face in the file
    bool before_first = false;           // a negative reference points before the first entry

    std::size_t size() const { return values.size() / width; }
    bool used() const { return !corners.empty(); }
    bool is_wrong() const { return highest > size() || before_first; }
};

struct Corner {
    std::uint32_t v = absent;
    std::uint32_t vt = absent;
    std::uint32_t vn = absent;
};

/// Counts distinct names. Memory: O(distinct names).
class DistinctNames {
  public:
    void add(std::string_view name) {
        if (name.empty() || (!names_.empty() && names_.back() == name)) return;
        if (names_.size() >= 2 * distinct_ + 64) count();
        names_.push_back(name);
    }
    std::uint64_t count() {
        std::sort(names_.begin(), names_.end());
        names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
        return distinct_ = names_.size();
    }

  private:
    std::vector<std::string_view> names_;
    std::size_t distinct_ = 0;
};

/// Counts the statements other than v, vt, vn and f.
class OtherStatements {
  public:
    void add(std::string_view keyword, TextScanner& rest) {
        if (keyword == "usemtl") return materials_.add(rest.rest_of_line());
        if (keyword == "mtllib") return libraries_.add(rest.rest_of_line());
        if (keyword == "o") return objects_.add(rest.rest_of_line());
        if (keyword == "g") return add_groups(rest);
        if (keyword == "s") return add_smoothing(rest.next_word_of_line());
        if (keyword == "l") return static_cast<void>(++lines_);
        if (keyword == "p") {
            while (!rest.next_word_of_line().empty()) ++points_;
            return;
        }
        if (keyword == "vp") return static_cast<void>(++parameters_);
        if (is_in(keyword, {"curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp"})) {
            ++free_forms_;
        } else if (is_in(keyword, {"call", "csh"})) {
            ++calls_;
        } else if (!is_in(keyword,
                          {"cstype",   "deg",      "bmat", "step",   "parm",   "trim",       "hole",     "scrv",
                           "sp",       "end",      "con",  "ctech",  "stech",  "res",        "mg",       "bevel",
                           "c_interp", "d_interp", "lod",  "maplib", "usemap", "shadow_obj", "trace_obj"})) {
            ++unknown_;
        }
    }

    void tell(Reading& reading) {
        reading.leave_out(materials_.count(), "material", "materials");
        reading.leave_out(libraries_.count(), "material library", "material libraries");
        reading.leave_out(objects_.count(), "object", "objects");
        reading.leave_out(groups_.count(), "group", "groups");
        reading.leave_out(smoothing_.count(), "smoothing group", "smoothing groups");
        reading.leave_out(lines_, "line", "lines");
        reading.leave_out(points_, "point", "points");
        reading.leave_out(free_forms_, "curve or surface", "curves and surfaces");
        reading.leave_out(parameters_, "parameter-space vertex", "parameter-space vertices");
        reading.leave_out(calls_, "call of another file", "calls of other files");
        reading.leave_out(unknown_, "unknown statement", "unknown statements");
    }

  private:
    static bool is_in(std::string_view word, std::initializer_list<std::string_view> words) {
        return std::find(words.begin(), words.end(), word) != words.end();
    }

    void add_groups(TextScanner& rest) {
        for (std::string_view name; !(name = rest.next_word_of_line()).empty();) {
            if (name != "default") groups_.add(name);  // "default" holds elements without a group
        }
    }

    void add_smoothing(std::string_view group) {
        if (group != "off" && group != "0") smoothing_.add(group);
    }

    DistinctNames materials_, libraries_, objects_, groups_, smoothing_;
    std::uint64_t lines_ = 0, points_ = 0, free_forms_ = 0, parameters_ = 0, calls_ = 0, unknown_ = 0;
};

using Sizes = std::array<std::uint64_t, 3>;  // numbers of entries of v, vt and vn

class ObjReader {
  public:
    /// If the final sizes of the lists are given, the first reference to a missing entry is an error at once.
    explicit ObjReader(std::string_view text, const Sizes* sizes = nullptr)
        : text_(text), scanner_(text, true, true), sizes_(sizes) {}

    Result<Mesh> read(Reading& reading) {
        LR_TRY(read_statements());
        LR_TRY(check_references());
        tell(reading);
        return build(reading);
    }

  private:
    Result<void> read_statements() {
        for (; !scanner_.at_end(); scanner_.skip_statement()) {
            const std::string_view keyword = scanner_.next_word_of_line();
            Result<void> good;
            if (keyword == "v") {
                good = read_vertex();
            } else if (keyword == "vt") {
                good = read_texture();
            } else if (keyword == "vn") {
                good = read_normal();
            } else if (keyword == "f" || keyword == "fo") {  // version 1 had "fo"; it means "f"
                good = read_face();
            } else if (!keyword.empty()) {
                others_.add(keyword, scanner_);
            }
            if (!good) return good;
        }
        return {};
    }

    template <class... Args>
    Error at_line(fmt::format_string<Args...> format, Args&&... args) const {
        return malformed("line {}: {}", scanner_.line(), fmt::format(format, std::forward<Args>(args)...));
    }

    /// Reads the line's numbers, from `least` to `most`, and returns their count.
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
        LR_ASSIGN(const auto count, read_line(numbers, 3, 7));
        if (!std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || !std::isfinite(numbers[2])) {
            return at_line("vertex {} is not finite", vertices_.size() + 1);
        }
        if (vertices_.size() == max_vertices) return too_many_vertices();
        // The numbers are x y z [w] or x y z r g b; colors are left out unless every vertex has one.
        if (count >= 6) {
            ++colored_;
            if (colors_.size() == vertices_.values.size()) colors_.insert(colors_.end(), numbers + 3, numbers + 6);
        } else if (count > 3 && numbers[3] != 1) {
            ++weights_;
        }
        if (count == 5 || count == 7) ++odd_;
        vertices_.values.insert(vertices_.values.end(), numbers, numbers + 3);
        return {};
    }

    Result<void> read_texture() {
        float numbers[3] = {};
        LR_TRY(read_line(numbers, 1, 3));
        if (textures_.size() == max_vertices) return too_many_vertices();
        if (numbers[2] != 0) ++depths_;
        textures_.values.insert(textures_.values.end(), numbers, numbers + 2);
        return {};
    }

    Result<void> read_normal() {
        float numbers[3] = {};
        LR_TRY(read_line(numbers, 3, 3));
        if (normals_.size() == max_vertices) return too_many_vertices();
        normals_.values.insert(normals_.values.end(), numbers, numbers + 3);
        return {};
    }

    Result<void> read_face() {
        Fan<Corner> fan;
        std::uint64_t corners = 0;
        while (true) {
            const std::string_view word = scanner_.next_word_of_line();
            if (word.empty()) break;
            // v, v/vt, v//vn or v/vt/vn; some programs write a trailing slash
            const std::size_t slash = std::min(word.find('/'), word.size());
            std::string_view vt = word.substr(std::min(slash + 1, word.size()));
            const std::size_t second = std::min(vt.find('/'), vt.size());
            const std::string_view vn = vt.substr(std::min(second + 1, vt.size()));
            vt = vt.substr(0, second);
            Corner corner;
            const bool good = resolve(vertices_, word.substr(0, slash), corner.v) &&
                              (vt.empty() || resolve(textures_, vt, corner.vt)) &&
                              (vn.empty() || resolve(normals_, vn, corner.vn));
            if (!good && missing_.message.empty()) return at_line("{} is not a corner of a face", shown(word));
            if (!good) return missing_;
            if (corner.vt != absent) start_using(textures_);
            if (corner.vn != absent) start_using(normals_);
            ++corners;
            fan.add(corner, [this](const Corner& a, const Corner& b, const Corner& c) {
                vertices_.corners.insert(vertices_.corners.end(), {a.v, b.v, c.v});
                if (textures_used_) textures_.corners.insert(textures_.corners.end(), {a.vt, b.vt, c.vt});
                if (normals_used_) normals_.corners.insert(normals_.corners.end(), {a.vn, b.vn, c.vn});
            });
        }
        polygons_.add(corners);
        return {};
    }

    /// Resolves an OBJ index to an entry: it counts from 1 or, if negative, back from the end of the list so far.
    bool resolve(List& list, std::string_view word, std::uint32_t& out) {
        std::int64_t number = 0;
        if (!parse_number(word, number) || number == 0) return false;
        const std::int64_t written = number;
        if (number < 0) number += static_cast<std::int64_t>(list.size()) + 1;
        ++list.references;
        if (number <= 0) {
            // Allowed if the file has no vt (vn) at all; before_first makes it an error if an entry follows.
            if (&list == &vertices_ || list.size() != 0) return false;
            list.before_first = true;
            number = 1;
        }
        if (static_cast<std::uint64_t>(number) > max_vertices) return false;
        const auto one_based = static_cast<std::uint64_t>(number);
        list.highest = std::max(list.highest, one_based);
        out = static_cast<std::uint32_t>(one_based - 1);
        return sizes_ == nullptr || exists(list, written, one_based);
    }

    bool exists(const List& list, std::int64_t written, std::uint64_t one_based) {
        const std::uint64_t size = (*sizes_)[&list == &vertices_ ? 0 : &list == &textures_ ? 1 : 2];
        if (&list != &vertices_ && size == 0) return true;
        if (one_based <= size && (written > 0 || list.size() != 0)) return true;
        missing_ = at_line("{} {} does not exist (there are {}{})", list.name, written,
                           written > 0 ? size : list.size(), written > 0 ? "" : " before it");
        return false;
    }

    void start_using(List& list) {
        bool& used = &list == &textures_ ? textures_used_ : normals_used_;
        if (used) return;
        used = true;
        list.corners.assign(vertices_.corners.size(), absent);
    }

    /// References to normals or texture coordinates are ignored if the file has none at all. Other references to
    /// missing entries are errors; the text is read again to find the first one.
    Result<void> check_references() {
        const auto is_absent = [](const List& list) { return list.size() == 0; };
        if (vertices_.is_wrong() || (textures_.is_wrong() && !is_absent(textures_)) ||
            (normals_.is_wrong() && !is_absent(normals_))) {
            const Sizes sizes{vertices_.size(), textures_.size(), normals_.size()};
            ObjReader again(text_, &sizes);
            if (auto good = again.read_statements(); !good) return good;
            return malformed("a face has a corner that does not exist");
        }
        for (List* list : {&textures_, &normals_}) {
            if (is_absent(*list)) list->corners = {};
        }
        return {};
    }

    void tell(Reading& reading) {
        others_.tell(reading);
        reading.leave_out(weights_, "vertex weight", "vertex weights");
        reading.leave_out(odd_, "vertex with 5 or 7 numbers", "vertices with 5 or 7 numbers");
        reading.leave_out(depths_, "third texture coordinate", "third texture coordinates");
        if (colored_ != vertices_.size()) {
            reading.leave_out(colored_, "color (not every vertex has one)", "colors (not every vertex has one)");
        }
        if (textures_.size() == 0) {
            reading.leave_out(textures_.references, "reference to texture coordinates, of which the file has none",
                              "references to texture coordinates, of which the file has none");
        }
        if (normals_.size() == 0) {
            reading.leave_out(normals_.references, "reference to normals, of which the file has none",
                              "references to normals, of which the file has none");
        }
    }

    Result<Mesh> build(Reading& reading) {
        if (vertices_.corners.empty()) return malformed("has no triangles");
        polygons_.cut({std::as_bytes(std::span(vertices_.values)).data(), false},
                      {&vertices_.corners, textures_.used() ? &textures_.corners : nullptr,
                       normals_.used() ? &normals_.corners : nullptr},
                      reading);
        Mesh mesh;
        // For each mesh vertex, its entry in each list. Without vt and vn they are unused: mesh vertices are the v
        // list.
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
            vt.resize(v.size(), absent);
            vn.resize(v.size(), absent);
            if (normals_.used()) mesh.attributes.push_back(gather("NORMAL", normals_, vn));
            if (textures_.used()) {
                mesh.attributes.push_back(gather("TEXCOORD_0", textures_, vt));
                mesh.attributes.back().v_up = true;
            }
        }
        if (!colors_.empty() && colors_.size() == vertices_.values.size()) {
            List colors{"color", 3, std::move(colors_), {}};
            mesh.attributes.push_back(v.empty() ? float_attribute("COLOR_0", 3, colors.values)
                                                : gather("COLOR_0", colors, v));
        }
        return checked(std::move(mesh));
    }

    Groups group_corners() const {
        const auto entry = [](const List& list, std::uint32_t i) { return list.used() ? list.corners[i] : absent; };
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

    /// Appends each v that no face uses as a mesh vertex, so that no position is lost.
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
            if (entries[i] == absent) continue;
            std::copy_n(list.values.data() + entries[i] * list.width, list.width, values.data() + i * list.width);
        }
        return float_attribute(std::move(name), static_cast<std::uint8_t>(list.width), values);
    }

    std::string_view text_;
    TextScanner scanner_;
    List vertices_{"vertex", 3, {}, {}};
    List textures_{"texture coordinate", 2, {}, {}};
    List normals_{"normal", 3, {}, {}};
    // List::used() of textures_ and normals_ is still false before the first triangle is complete.
    bool textures_used_ = false;
    bool normals_used_ = false;
    PolygonList polygons_;
    std::vector<float> colors_;
    OtherStatements others_;
    std::uint64_t colored_ = 0, weights_ = 0, odd_ = 0, depths_ = 0;
    const Sizes* sizes_;
    Error missing_{ErrorCode::malformed, {}};
};

}  // namespace

Result<Mesh> read_obj(std::string_view text, Reading& reading) {
    return ObjReader(text).read(reading);
}

}  // namespace lacedring::detail
