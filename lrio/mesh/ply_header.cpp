#include "lrio/mesh/ply_header.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/text_scanner.h"

namespace lacedring::detail {
namespace {

bool parse_type(std::string_view word, ComponentType& out) {
    constexpr std::pair<std::string_view, ComponentType> names[] = {
        {"char", ComponentType::i8},     {"int8", ComponentType::i8},     {"uchar", ComponentType::u8},
        {"uint8", ComponentType::u8},    {"short", ComponentType::i16},   {"int16", ComponentType::i16},
        {"ushort", ComponentType::u16},  {"uint16", ComponentType::u16},  {"int", ComponentType::i32},
        {"int32", ComponentType::i32},   {"uint", ComponentType::u32},    {"uint32", ComponentType::u32},
        {"float", ComponentType::f32},   {"float32", ComponentType::f32}, {"double", ComponentType::f64},
        {"float64", ComponentType::f64},
    };
    for (const auto& [name, type] : names) {
        if (name == word) {
            out = type;
            return true;
        }
    }
    return false;
}

bool is_real(ComponentType type) {
    return type == ComponentType::f32 || type == ComponentType::f64;
}

class HeaderParser {
  public:
    explicit HeaderParser(std::string_view bytes) : bytes_(bytes) {
        // Some files end lines with CR alone: the first line shows which line end to use.
        newline_ = bytes.starts_with("ply\r") && !bytes.starts_with("ply\r\n") ? '\r' : '\n';
    }

    Result<PlyHeader> parse() {
        bool format_known = false;
        while (true) {
            const std::size_t end = bytes_.find(newline_, at_);
            if (end == std::string_view::npos) return malformed("line {}: the header has no end_header", line_ + 1);
            std::string_view text = bytes_.substr(at_, end - at_);
            if (text.ends_with('\r')) text.remove_suffix(1);
            at_ = end + 1;
            ++line_;
            TextScanner words(text);
            const std::string_view keyword = words.next_word();
            if (line_ == 1 && keyword != "ply") return malformed("line 1: does not begin with 'ply'");
            Result<void> good;
            if (keyword == "end_header") break;
            if (keyword == "format") {
                good = parse_format(words);
                format_known = true;
            } else if (keyword == "element") {
                good = parse_element(words);
            } else if (keyword == "property") {
                good = parse_property(words);
            } else if (keyword == "comment") {
                parse_comment(words, text);
            } else if (!keyword.empty() && keyword != "obj_info" && keyword != "ply") {
                good = malformed("line {}: {} in the header", line_, shown(keyword));
            }
            if (!good) return good.error();
        }
        if (!format_known) return malformed("line {}: the header names no format", line_);
        header_.bytes = at_;
        return std::move(header_);
    }

  private:
    Result<void> parse_format(TextScanner& words) {
        const std::string_view word = words.next_word();
        if (word == "ascii") {
            header_.format = PlyFormat::ascii;
        } else if (word == "binary_little_endian") {
            header_.format = PlyFormat::little_endian;
        } else if (word == "binary_big_endian") {
            header_.format = PlyFormat::big_endian;
        } else {
            return unsupported("line {}: PLY format {}", line_, shown(word));
        }
        return {};
    }

    Result<void> parse_element(TextScanner& words) {
        PlyElement element;
        element.name = words.next_word();
        element.line = line_;
        const std::string_view count = words.next_word();
        if (element.name.empty() || !parse_number(count, element.count)) {
            return malformed("line {}: {} is not a number of elements", line_, shown(count));
        }
        header_.elements.push_back(std::move(element));
        return {};
    }

    Result<void> parse_property(TextScanner& words) {
        if (header_.elements.empty()) return malformed("line {}: a property before any element", line_);
        PlyProperty property;
        std::string_view type = words.next_word();
        if (type == "list") {
            property.is_list = true;
            const std::string_view count_type = words.next_word();
            if (!parse_type(count_type, property.count_type) || is_real(property.count_type)) {
                return malformed("line {}: {} is not a type of a list's length", line_, shown(count_type));
            }
            type = words.next_word();
        }
        if (!parse_type(type, property.type)) return malformed("line {}: {} is not a type", line_, shown(type));
        property.name = words.next_word();
        if (property.name.empty()) return malformed("line {}: a property without a name", line_);
        header_.elements.back().properties.push_back(std::move(property));
        return {};
    }

    void parse_comment(TextScanner& words, std::string_view line) {
        words.skip_blanks();
        std::string_view text = line.substr(line.size() - words.remaining());
        if (!text.starts_with(ply_note_prefix)) return;
        TextScanner note(text.substr(ply_note_prefix.size()));
        PlyAttributeNote out;
        unsigned flags = 0;
        if (!parse_number(note.next_word(), out.components) || !parse_number(note.next_word(), flags)) return;
        note.skip_blanks();
        out.normalized = (flags & 1U) != 0;
        out.v_up = (flags & 2U) != 0;
        out.name = unescape_ply_name(text.substr(text.size() - note.remaining()));
        header_.notes.push_back(std::move(out));
    }

    std::string_view bytes_;
    char newline_ = '\n';
    std::size_t at_ = 0;
    std::size_t line_ = 0;
    PlyHeader header_;
};

/// The attributes of the notes; empty if the notes do not match the properties, because another program edited them.
std::vector<PlyAttribute> plan_from_notes(const PlyElement& vertex, const std::vector<PlyAttributeNote>& notes) {
    std::vector<PlyAttribute> plan;
    std::size_t next = 0;
    for (const PlyAttributeNote& note : notes) {
        if (note.components == 0 || note.components > vertex.properties.size() - next) return {};
        PlyAttribute entry;
        entry.attribute = {note.name, vertex.properties[next].type, note.components, note.normalized, {}, note.v_up};
        for (std::size_t i = 0; i < note.components; ++i, ++next) {
            const PlyProperty& property = vertex.properties[next];
            if (property.is_list || property.type != entry.attribute.type) return {};
            entry.properties.push_back(next);
        }
        plan.push_back(std::move(entry));
    }
    if (plan.empty() || next != vertex.properties.size()) return {};
    const Attribute& position = plan.front().attribute;
    if (position.name != "POSITION" || position.components != 3 || !is_real(position.type)) return {};
    return plan;
}

class PropertyPlanner {
  public:
    explicit PropertyPlanner(const PlyElement& vertex) : vertex_(vertex), taken_(vertex.properties.size(), false) {}

    Result<std::vector<PlyAttribute>> plan() {
        std::vector<std::size_t> xyz;
        for (const std::string_view name : {"x", "y", "z"}) xyz.push_back(find(name));
        if (std::find(xyz.begin(), xyz.end(), missing) != xyz.end()) {
            return malformed("line {}: the vertices have no x, y and z", vertex_.line);
        }
        const bool all_double = std::all_of(
            xyz.begin(), xyz.end(), [this](std::size_t i) { return vertex_.properties[i].type == ComponentType::f64; });
        add("POSITION", all_double ? ComponentType::f64 : ComponentType::f32, false, xyz);

        take_group("NORMAL", {"nx", "ny", "nz"});
        if (!take_group("TEXCOORD_0", {"s", "t"}) && !take_group("TEXCOORD_0", {"u", "v"})) {
            take_group("TEXCOORD_0", {"texture_u", "texture_v"});
        }
        if (!take_group("COLOR_0", {"red", "green", "blue", "alpha"})) take_group("COLOR_0", {"red", "green", "blue"});

        for (std::size_t i = 0; i < vertex_.properties.size(); ++i) {
            const PlyProperty& property = vertex_.properties[i];
            if (!taken_[i] && !property.is_list) add(property.name, property.type, false, {i});
        }
        return std::move(plan_);
    }

  private:
    static constexpr std::size_t missing = SIZE_MAX;

    std::size_t find(std::string_view name) const {
        for (std::size_t i = 0; i < vertex_.properties.size(); ++i) {
            if (!taken_[i] && !vertex_.properties[i].is_list && vertex_.properties[i].name == name) return i;
        }
        return missing;
    }

    /// Joins properties to one attribute if they exist and have one suitable type; else leaves them separate.
    bool take_group(std::string_view name, std::initializer_list<std::string_view> names) {
        std::vector<std::size_t> group;
        for (const std::string_view component : names) {
            const std::size_t i = find(component);
            if (i == missing) return false;
            if (!group.empty() && vertex_.properties[i].type != vertex_.properties[group.front()].type) return false;
            group.push_back(i);
        }
        const ComponentType type = vertex_.properties[group.front()].type;
        const bool color = name == "COLOR_0" && (type == ComponentType::u8 || type == ComponentType::u16);
        if (!color && !is_real(type)) return false;
        add(name, type, color, std::move(group));
        return true;
    }

    void add(std::string_view name, ComponentType type, bool normalized, std::vector<std::size_t> properties) {
        for (const std::size_t i : properties) taken_[i] = true;
        const auto components = static_cast<std::uint8_t>(properties.size());
        const bool v_up = name == "TEXCOORD_0";
        plan_.push_back({{std::string(name), type, components, normalized, {}, v_up}, std::move(properties)});
    }

    const PlyElement& vertex_;
    std::vector<bool> taken_;
    std::vector<PlyAttribute> plan_;
};

}  // namespace

Result<PlyHeader> parse_ply_header(std::string_view bytes) {
    return HeaderParser(bytes).parse();
}

Result<std::vector<PlyAttribute>> plan_ply_attributes(const PlyElement& vertex,
                                                      const std::vector<PlyAttributeNote>& notes) {
    std::vector<PlyAttribute> noted = plan_from_notes(vertex, notes);
    if (!noted.empty()) return noted;
    return PropertyPlanner(vertex).plan();
}

std::string escape_ply_name(std::string_view name) {
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const bool at_edge = i == 0 || i + 1 == name.size();
        if (c == '%' || (c >= 0 && c < ' ') || c == '\x7F' || (c == ' ' && at_edge)) {
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        } else {
            out += c;
        }
    }
    return out;
}

std::string unescape_ply_name(std::string_view name) {
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        unsigned value = 0;
        if (name[i] == '%' && i + 2 < name.size() &&
            std::from_chars(name.data() + i + 1, name.data() + i + 3, value, 16).ptr == name.data() + i + 3) {
            out += static_cast<char>(value);
            i += 2;
        } else {
            out += name[i];
        }
    }
    return out;
}

}  // namespace lacedring::detail
