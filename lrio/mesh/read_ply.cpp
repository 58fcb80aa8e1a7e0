// Reads PLY: ascii and binary of both byte orders. Faces may be lists or triangle strips, in any order of elements.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lrcore/base/try.h"
#include "lrio/mesh/ply_header.h"
#include "lrio/mesh/polygon.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/text_scanner.h"

namespace lacedring::detail {
namespace {

/// Calls f with a value of the C++ type that `type` names.
template <class F>
auto with_type(ComponentType type, const F& f) {
    switch (type) {
        case ComponentType::i8:
            return f(std::int8_t{});
        case ComponentType::u8:
            return f(std::uint8_t{});
        case ComponentType::i16:
            return f(std::int16_t{});
        case ComponentType::u16:
            return f(std::uint16_t{});
        case ComponentType::i32:
            return f(std::int32_t{});
        case ComponentType::u32:
            return f(std::uint32_t{});
        case ComponentType::f32:
            return f(float{});
        case ComponentType::f64:
            break;
    }
    return f(double{});
}

/// Number of lines that are not blank.
std::uint64_t count_lines(std::string_view data) {
    const char newline = data.find('\n') == std::string_view::npos ? '\r' : '\n';
    std::uint64_t lines = 0;
    for (std::size_t at = 0; at < data.size();) {
        const std::size_t end = std::min(data.find(newline, at), data.size());
        while (at < end && TextScanner::is_space(data[at])) ++at;
        if (at < end) ++lines;
        at = end + 1;
    }
    return lines;
}

/// The data as words, with one element per line or with line ends as ordinary white space.
template <bool by_line>
class AsciiSource {
  public:
    AsciiSource(std::string_view bytes, std::size_t data) : text_(bytes), scanner_(text_) {
        while (scanner_.position() < text_.data() + data) scanner_.skip_line();
        scanner_.skip_space();
    }

    std::size_t most_values() const { return scanner_.remaining() / 2 + 1; }
    static std::size_t cost(ComponentType) { return 1; }

    template <class T>
    bool read(T& out) {
        word_ = next_word();
        if (parse_number(word_, out)) return true;
        if constexpr (std::is_integral_v<T>) {  // some programs write 255.0 for a uchar
            double real = 0;
            if (parse_number(word_, real) && real == std::floor(real) && std::abs(real) < 4294967296.0) {
                const auto whole = static_cast<std::int64_t>(real);
                out = static_cast<T>(whole);
                return static_cast<std::int64_t>(out) == whole;
            }
        }
        return false;
    }

    bool skip(ComponentType, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            word_ = next_word();
            if (word_.empty()) return false;
        }
        return true;
    }

    void end_element() {
        if (!by_line) return;
        if (!scanner_.skip_to_line_end()) {
            ++longer_;
            scanner_.skip_line();
        }
        scanner_.skip_space();
    }

    /// Number of lines that have more values than their element.
    std::uint64_t longer_lines() const { return longer_; }

    std::size_t bytes_left() {
        scanner_.skip_space();
        return scanner_.remaining();
    }

    Error bad_value(std::string_view element, std::uint64_t number) const {
        if (word_.empty()) {
            const std::string_view what = by_line && !scanner_.at_end() ? "line" : "file";
            return malformed("line {}: the {} ends in {} {}", scanner_.line(), what, element, number);
        }
        return malformed("line {}: {} {}: {} is not a number of its type", scanner_.line(), element, number,
                         shown(word_));
    }
    std::string place() const { return fmt::format("line {}", scanner_.line()); }

  private:
    std::string_view next_word() { return by_line ? scanner_.next_word_of_line() : scanner_.next_word(); }

    std::string_view text_;
    TextScanner scanner_;
    std::uint64_t longer_ = 0;
    std::string_view word_;
};

template <bool big_endian>
class BinarySource {
  public:
    BinarySource(std::string_view bytes, std::size_t data)
        : begin_(bytes.data()), at_(begin_ + data), end_(begin_ + bytes.size()) {}

    std::size_t most_values() const { return static_cast<std::size_t>(end_ - at_); }
    static std::size_t cost(ComponentType type) { return size_of(type); }

    template <class T>
    bool read(T& out) {
        if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) return false;
        char bytes[sizeof(T)];
        std::memcpy(bytes, at_, sizeof(T));
        if constexpr (big_endian) std::reverse(bytes, bytes + sizeof(T));
        std::memcpy(&out, bytes, sizeof(T));
        at_ += sizeof(T);
        return true;
    }

    bool skip(ComponentType type, std::uint64_t count) {
        const std::size_t size = size_of(type);
        if (static_cast<std::size_t>(end_ - at_) / size < count) return false;
        at_ += count * size;
        return true;
    }

    void end_element() {}
    static std::uint64_t longer_lines() { return 0; }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    Error bad_value(std::string_view element, std::uint64_t number) const {
        return malformed("byte {}: the file ends in {} {}", at_ - begin_, element, number);
    }
    std::string place() const { return fmt::format("byte {}", at_ - begin_); }

  private:
    const char* begin_;
    const char* at_;
    const char* end_;
};

template <class Source>
class PlyReader {
  public:
    PlyReader(std::string_view bytes, const PlyHeader& header) : header_(header), source_(bytes, header.bytes) {}

    Result<Mesh> read(Reading& reading) {
        const PlyElement* vertex = nullptr;
        for (const PlyElement& element : header_.elements) {
            if (element.name != "vertex") continue;
            if (vertex != nullptr) return malformed("line {}: a second element vertex", element.line);
            vertex = &element;
        }
        if (vertex == nullptr) return malformed("the header has no element vertex");
        if (vertex->count > max_vertices) return too_many_vertices();
        if (vertex->properties.empty()) return malformed("line {}: the vertices have no x, y and z", vertex->line);
        mesh_.vertex_count = static_cast<std::uint32_t>(vertex->count);

        for (const PlyElement& element : header_.elements) {
            LR_TRY(check_count(element));
            if (element.properties.empty()) continue;  // takes no bytes, whatever its count
            const bool faces = element.name == "face";
            const bool strips = element.name == "tristrips";
            LR_TRY(&element == vertex ? read_vertices(element)
                   : faces || strips  ? read_polygons(element, strips)
                                      : skip_element(element));
        }
        tell(reading, *vertex);
        reading.leave_out(source_.bytes_left(), "byte after the last element", "bytes after the last element");
        const Attribute& position = mesh_.attributes.front();
        polygons_.cut({position.data.data(), position.type == ComponentType::f64}, {&mesh_.indices}, reading);
        return checked(std::move(mesh_));
    }

  private:
    /// Checks that the remaining bytes can hold the elements, before memory is allocated for them.
    Result<void> check_count(const PlyElement& element) const {
        std::size_t least = 0;
        for (const PlyProperty& property : element.properties) {
            least += Source::cost(property.is_list ? property.count_type : property.type);
        }
        if (least == 0 || element.count <= source_.most_values() / least) return {};
        return malformed("line {}: {} elements {} are more than the file has bytes for", element.line, element.count,
                         shown(element.name));
    }

    Result<void> read_vertices(const PlyElement& vertex) {
        LR_ASSIGN(auto plan, plan_ply_attributes(vertex, header_.notes));
        // Where each property's values go, `stride` bytes apart; null for lists, which are skipped.
        struct Target {
            std::byte* at = nullptr;
            std::size_t stride = 0;
            ComponentType stored = ComponentType::f32;
            bool is_position = false;
        };
        std::vector<Target> targets(vertex.properties.size());
        mesh_.attributes.reserve(plan.size());
        for (PlyAttribute& entry : plan) {
            const std::size_t stride = entry.attribute.stride();
            const ComponentType type = entry.attribute.type;
            const bool is_position = mesh_.attributes.empty();
            entry.attribute.data.resize(stride * mesh_.vertex_count);
            // Without vertices there are no bytes to point at.
            for (std::size_t i = 0; mesh_.vertex_count != 0 && i < entry.properties.size(); ++i) {
                targets[entry.properties[i]] = {entry.attribute.data.data() + i * size_of(type), stride, type,
                                                is_position};
            }
            mesh_.attributes.push_back(std::move(entry.attribute));  // moving keeps the targets valid
        }
        for (std::uint64_t v = 0; v < vertex.count; ++v) {
            for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
                const PlyProperty& property = vertex.properties[p];
                Target& target = targets[p];
                const bool good = target.at == nullptr ? skip_property(property)
                                                       : read_value(property.type, target.stored, target.at);
                if (!good) return source_.bad_value("vertex", v);
                if (target.at == nullptr) continue;
                if (target.is_position && !is_finite(target.stored, target.at)) {
                    return malformed("{}: vertex {}: {} is not finite", source_.place(), v, shown(property.name));
                }
                target.at += target.stride;
            }
            source_.end_element();
        }
        return {};
    }

    static bool is_finite(ComponentType type, const std::byte* at) {
        return with_type(type, [at](auto value) {
            std::memcpy(&value, at, sizeof(value));
            return std::isfinite(static_cast<double>(value));
        });
    }

    bool read_value(ComponentType type, ComponentType stored, std::byte* at) {
        return with_type(type, [&](auto value) {
            if (!source_.read(value)) return false;
            if (stored == type) {
                std::memcpy(at, &value, sizeof(value));
            } else {  // only positions of mixed or integer types
                const auto converted = static_cast<float>(value);
                std::memcpy(at, &converted, sizeof(converted));
            }
            return true;
        });
    }

    bool read_integer(ComponentType type, std::int64_t& out) {
        return with_type(type, [&](auto value) {
            if constexpr (std::is_integral_v<decltype(value)>) {
                if (!source_.read(value)) return false;
                out = std::int64_t{value};
                return true;
            } else {
                return false;
            }
        });
    }

    bool skip_property(const PlyProperty& property) {
        if (!property.is_list) return source_.skip(property.type, 1);
        std::int64_t count = 0;
        return read_integer(property.count_type, count) && count >= 0 &&
               source_.skip(property.type, static_cast<std::uint64_t>(count));
    }

    Result<void> skip_element(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties) {
                if (!skip_property(property)) return source_.bad_value("element", i);
            }
            source_.end_element();
        }
        return {};
    }

    static const PlyProperty* find_indices(const PlyElement& element) {
        for (const PlyProperty& property : element.properties) {
            const bool named = property.name == "vertex_indices" || property.name == "vertex_index";
            if (named && property.is_list) return &property;
        }
        return nullptr;
    }

    Result<void> read_polygons(const PlyElement& element, bool strips) {
        const PlyProperty* indices = find_indices(element);
        if (indices == nullptr) return skip_element(element);
        if (indices->type == ComponentType::f32 || indices->type == ComponentType::f64) {
            return malformed("line {}: the indices of element {} are not integers", element.line, shown(element.name));
        }
        if (!strips) mesh_.indices.reserve(mesh_.indices.size() + static_cast<std::size_t>(element.count) * 3);
        for (std::uint64_t f = 0; f < element.count; ++f) {
            for (const PlyProperty& property : element.properties) {
                if (&property == indices) {
                    if (auto good = read_list(*indices, strips, f); !good) return good;
                } else if (!skip_property(property)) {
                    return source_.bad_value(strips ? "strip" : "face", f);
                }
            }
            source_.end_element();
        }
        return {};
    }

    Result<void> read_list(const PlyProperty& list, bool is_strip, std::uint64_t number) {
        const std::string_view what = is_strip ? "strip" : "face";
        std::int64_t count = 0;
        if (!read_integer(list.count_type, count)) return source_.bad_value(what, number);
        if (count < 0) return malformed("{}: {} {}: {} indices", source_.place(), what, number, count);
        return with_type(list.type, [&](auto zero) -> Result<void> {
            if constexpr (std::is_integral_v<decltype(zero)>) {
                return is_strip ? read_strip<decltype(zero)>(count, number) : read_face<decltype(zero)>(count, number);
            } else {
                return {};
            }
        });
    }

    template <class Integer>
    Result<void> read_face(std::int64_t count, std::uint64_t number) {
        Fan<std::uint32_t> fan;
        for (std::int64_t i = 0; i < count; ++i) {
            Integer index{};
            if (!source_.read(index)) return source_.bad_value("face", number);
            if (!is_vertex(index)) return out_of_range("face", number, index);
            fan.add(static_cast<std::uint32_t>(index), [this](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
            });
        }
        polygons_.add(static_cast<std::uint64_t>(count));
        return {};
    }

    template <class Integer>
    Result<void> read_strip(std::int64_t count, std::uint64_t number) {
        Strip strip;
        const std::size_t before = mesh_.indices.size();
        for (std::int64_t i = 0; i < count; ++i) {
            Integer index{};
            if (!source_.read(index)) return source_.bad_value("strip", number);
            if (std::int64_t{index} == -1) {
                strip.restart();
            } else {
                if (!is_vertex(index)) return out_of_range("strip", number, index);
                strip.add(static_cast<std::uint32_t>(index), mesh_.indices);
            }
        }
        polygons_.skip((mesh_.indices.size() - before) / 3);
        return {};
    }

    bool is_vertex(std::int64_t index) const { return index >= 0 && index < std::int64_t{mesh_.vertex_count}; }

    Error out_of_range(std::string_view what, std::uint64_t number, std::int64_t index) const {
        return malformed("{}: {} {}: index {} is out of range ({} vertices)", source_.place(), what, number, index,
                         mesh_.vertex_count);
    }

    void tell(Reading& reading, const PlyElement& vertex) const {
        constexpr std::size_t kNames = 4;
        std::size_t kinds = 0;
        std::uint64_t others = 0;
        for (const PlyElement& element : header_.elements) {
            const bool has_indices =
                (element.name == "face" || element.name == "tristrips") && find_indices(element) != nullptr;
            if (&element == &vertex || has_indices || element.properties.empty()) continue;
            if (element.count != 0 && ++kinds > kNames) {
                others += element.count;
            } else {
                const std::string name = shown(element.name);
                reading.leave_out(element.count, "element " + name, "elements " + name);
            }
        }
        reading.leave_out(others, "further element", "further elements");
        for (const PlyElement& element : header_.elements) {
            const PlyProperty* indices = find_indices(element);
            const bool is_vertex = &element == &vertex;
            if (element.count == 0 || (!is_vertex && indices == nullptr)) continue;
            std::uint64_t count = 0;
            std::string names;
            for (const PlyProperty& property : element.properties) {
                if (is_vertex ? !property.is_list : &property == indices) continue;
                if (++count <= kNames) names += (count == 1 ? " " : ", ") + shown(property.name);
                if (count == kNames + 1) names += ", ...";
            }
            if (is_vertex) {
                reading.leave_out(count, "list of vertices:" + names, "lists of vertices:" + names);
            } else if (element.name == "face" || element.name == "tristrips") {
                const std::string_view of = element.name == "face" ? "faces:" : "strips:";
                reading.leave_out(count, fmt::format("property of {}{}", of, names),
                                  fmt::format("properties of {}{}", of, names));
            }
        }
        reading.leave_out(source_.longer_lines(), "line with values after its element's",
                          "lines with values after their elements'");
    }

    const PlyHeader& header_;
    Source source_;
    Mesh mesh_;
    PolygonList polygons_;
};

/// If there are as many lines of data as elements, reads an element from each line and skips the rest of the line.
/// Otherwise, or if a line is too short, line ends are ordinary white space.
Result<Mesh> read_ascii(std::string_view bytes, const PlyHeader& header, Reading& reading) {
    double elements = 0;  // as an integer it could overflow
    for (const PlyElement& element : header.elements) {
        if (!element.properties.empty()) elements += static_cast<double>(element.count);
    }
    if (static_cast<double>(count_lines(bytes.substr(header.bytes))) != elements) {
        return PlyReader<AsciiSource<false>>(bytes, header).read(reading);
    }
    auto mesh = PlyReader<AsciiSource<true>>(bytes, header).read(reading);
    if (mesh) return mesh;
    const std::size_t told = reading.report.left_out.size();
    auto again = PlyReader<AsciiSource<false>>(bytes, header).read(reading);
    if (again) return again;
    reading.report.left_out.resize(told);
    return mesh;
}

}  // namespace

Result<Mesh> read_ply(std::string_view bytes, Reading& reading) {
    LR_ASSIGN(const auto header, parse_ply_header(bytes));
    switch (header.format) {
        case PlyFormat::ascii:
            return read_ascii(bytes, header, reading);
        case PlyFormat::little_endian:
            return PlyReader<BinarySource<false>>(bytes, header).read(reading);
        case PlyFormat::big_endian:
            break;
    }
    return PlyReader<BinarySource<true>>(bytes, header).read(reading);
}

}  // namespace lacedring::detail
