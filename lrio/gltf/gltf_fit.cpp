// Converts a mesh's attributes to the types and values that glTF allows.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "lrcore/base/try.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/write_formats.h"

namespace lacedring::detail {
namespace {

template <class T>
T load(const std::vector<std::byte>& data, std::size_t i) {
    T value{};
    std::memcpy(&value, data.data() + i * sizeof(T), sizeof(T));
    return value;
}
template <class T>
void store(std::vector<std::byte>& data, std::size_t i, T value) {
    std::memcpy(data.data() + i * sizeof(T), &value, sizeof(T));
}

/// Converts values to floats. False: `exact_only`, and some value is not representable.
template <class From>
bool to_floats(const Attribute& from, bool exact_only, Attribute& to) {
    const std::size_t count = from.data.size() / sizeof(From);
    to.data.resize(count * sizeof(float));
    for (std::size_t i = 0; i < count; ++i) {
        const auto value = load<From>(from.data, i);
        const auto rounded = static_cast<float>(value);
        if (exact_only && static_cast<double>(rounded) != static_cast<double>(value)) return false;
        store(to.data, i, rounded);
    }
    return true;
}

/// glTF attributes have no doubles and no 32-bit integers: rounds doubles to floats, and converts integers to floats if
/// all are representable. Null: the attribute cannot be kept.
std::optional<Attribute> convert(const Attribute& from) {
    Attribute to{from.name, ComponentType::f32, from.components, false, {}, from.v_up};
    switch (from.type) {
        case ComponentType::f64:
            to_floats<double>(from, false, to);
            return to;
        case ComponentType::i32:
            if (from.normalized || !to_floats<std::int32_t>(from, true, to)) return std::nullopt;
            return to;
        case ComponentType::u32:
            if (from.normalized || !to_floats<std::uint32_t>(from, true, to)) return std::nullopt;
            return to;
        default:
            return from;
    }
}

/// Has glTF a type for this number of components? Matrices of small integers, whose columns glTF pads, are not written.
bool has_type(const Attribute& attribute) {
    if (attribute.components >= 1 && attribute.components <= 4) return true;
    return attribute.type == ComponentType::f32 && (attribute.components == 9 || attribute.components == 16);
}

enum class Fit { core, quantized, no };

bool has_numbered_name(const std::string& name, std::string_view prefix) {
    const std::string_view number = std::string_view(name).substr(std::min(prefix.size(), name.size()));
    return name.starts_with(prefix) && !number.empty() && number.size() < 6 &&
           (number.size() == 1 || number[0] != '0') &&
           std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Does glTF allow this type for an attribute of this name? Fit::quantized: only with KHR_mesh_quantization.
Fit fit(const Attribute& a) {
    const bool is_float = a.type == ComponentType::f32;
    const bool is_signed = a.type == ComponentType::i8 || a.type == ComponentType::i16;
    const bool is_unsigned = a.type == ComponentType::u8 || a.type == ComponentType::u16;
    const auto choose = [](bool core, bool quantized) {
        return core ? Fit::core : quantized ? Fit::quantized : Fit::no;
    };
    if (a.name == "POSITION") return choose(a.components == 3 && is_float, false);
    if (a.name == "NORMAL") return a.components == 3 ? choose(is_float, is_signed && a.normalized) : Fit::no;
    if (a.name == "TANGENT") return a.components == 4 ? choose(is_float, is_signed && a.normalized) : Fit::no;
    if (has_numbered_name(a.name, "TEXCOORD_")) {
        return a.components == 2 ? choose(is_float || (is_unsigned && a.normalized), is_signed || is_unsigned)
                                 : Fit::no;
    }
    if (has_numbered_name(a.name, "COLOR_")) {
        return choose((a.components == 3 || a.components == 4) && (is_float || (is_unsigned && a.normalized)), false);
    }
    if (has_numbered_name(a.name, "JOINTS_")) return choose(a.components == 4 && is_unsigned && !a.normalized, false);
    if (has_numbered_name(a.name, "WEIGHTS_")) {
        return choose(a.components == 4 && (is_float || (is_unsigned && a.normalized)), false);
    }
    return a.name.starts_with('_') ? Fit::core : Fit::no;
}

/// The name as valid UTF-8: invalid bytes become U+FFFD.
std::string utf8(const std::string& name) {
    return nlohmann::json::parse(nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
        .get<std::string>();
}

class Fitter {
  public:
    Fitter(const Mesh& mesh, WriteNotes& notes) : mesh_(mesh), notes_(notes) {}

    Result<GltfAttributes> run() {
        std::set<std::string> known;  // names written so far that glTF defines
        for (const Attribute& from : mesh_.attributes) {
            std::optional<Attribute> to = convert(from);
            if (!to || !has_type(*to)) {
                left_out_.push_back(from.name);
                continue;
            }
            const bool is_position = out_.attributes.empty();
            if (is_position) {
                LR_TRY(check_positions(*to));
            } else {
                mend_values(*to);
            }
            const Fit how = known.contains(to->name) ? Fit::no : fit(*to);
            if (how == Fit::no || !values_allowed(*to)) {
                to->name.insert(0, 1, '_');
                renamed_.push_back(from.name);
            } else {
                known.insert(to->name);
                out_.quantized = out_.quantized || how == Fit::quantized;
            }
            out_.attributes.push_back(std::move(*to));
        }
        rename_lonely(known);
        UniqueNames names;
        for (Attribute& attribute : out_.attributes) attribute.name = names.take(utf8(attribute.name));
        if (!left_out_.empty()) notes_.push_back("glTF has no type for " + shown_names(left_out_) + ": left out");
        if (!renamed_.empty()) notes_.push_back("not as glTF defines it, so named _NAME: " + shown_names(renamed_));
        return std::move(out_);
    }

  private:
    static Result<void> check_positions(const Attribute& position) {
        for (std::size_t i = 0; i * sizeof(float) < position.data.size(); ++i) {
            if (!std::isfinite(load<float>(position.data, i))) {
                return Error{ErrorCode::invalid_argument, fmt::format("vertex {} is not finite as floats", i / 3)};
            }
        }
        return {};
    }

    /// Replaces NaN and infinity by 0, makes normals and tangents unit vectors, and flips v if the attribute is v_up.
    void mend_values(Attribute& a) {
        const bool is_normal = a.name == "NORMAL" && a.components == 3;
        const bool is_tangent = a.name == "TANGENT" && a.components == 4;
        if ((is_normal || is_tangent) && (a.type == ComponentType::f32 || a.normalized)) {
            mend_directions(a, is_normal);
        } else if (a.type == ComponentType::f32) {
            std::size_t count = 0;
            for (std::size_t i = 0; i * sizeof(float) < a.data.size(); ++i) {
                if (std::isfinite(load<float>(a.data, i))) continue;
                store(a.data, i, 0.0F);
                ++count;
            }
            if (count > 0)
                notes_.push_back(fmt::format("{}: {} values that are not finite became 0", shown(a.name), count));
        }
        if (a.v_up && has_numbered_name(a.name, "TEXCOORD_") && a.components == 2) turn_v(a);
    }

    static void turn_v(Attribute& a) {
        a.v_up = false;
        for (std::size_t i = 1; i < a.data.size() / size_of(a.type); i += 2) {
            if (a.type == ComponentType::f32) {
                store(a.data, i, 1.0F - load<float>(a.data, i));
            } else if (a.type == ComponentType::u8 && a.normalized) {
                store(a.data, i, static_cast<std::uint8_t>(255 - load<std::uint8_t>(a.data, i)));
            } else if (a.type == ComponentType::u16 && a.normalized) {
                store(a.data, i, static_cast<std::uint16_t>(65535 - load<std::uint16_t>(a.data, i)));
            }
        }
    }

    using Vector = std::array<double, 4>;

    /// Normalizes directions whose length is not 1. Directions without a length become the triangles' normal, or
    /// (1, 0, 0) if they are tangents.
    void mend_directions(Attribute& a, bool is_normal) {
        constexpr double kTolerance = 0.005;  // the length error of 8-bit directions
        const std::size_t width = a.components;
        const auto value = [&](std::size_t i) {
            switch (a.type) {
                case ComponentType::i8:
                    return std::max(load<std::int8_t>(a.data, i) / 127.0, -1.0);
                case ComponentType::i16:
                    return std::max(load<std::int16_t>(a.data, i) / 32767.0, -1.0);
                case ComponentType::u8:
                    return load<std::uint8_t>(a.data, i) / 255.0;
                case ComponentType::u16:
                    return load<std::uint16_t>(a.data, i) / 65535.0;
                default:
                    return static_cast<double>(load<float>(a.data, i));
            }
        };
        Attribute floats{a.name, ComponentType::f32, a.components, false, {}};
        floats.data.resize(std::size_t{mesh_.vertex_count} * width * sizeof(float));
        std::vector<float> from_triangles;
        std::size_t scaled = 0, made = 0;
        for (std::size_t v = 0; v < mesh_.vertex_count; ++v) {
            Vector d{0, 0, 0, 1};
            for (std::size_t c = 0; c < width; ++c) d[c] = value(v * width + c);
            const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            const bool sign_good = is_normal || d[3] == 1 || d[3] == -1;
            if (!(length > 0) || !std::isfinite(length)) {
                ++made;
                d = {1, 0, 0, 1};
                if (is_normal) {
                    if (from_triangles.empty()) from_triangles = triangle_normals();
                    std::copy_n(&from_triangles[3 * v], 3, d.begin());
                }
            } else if (std::abs(length - 1) > kTolerance || !sign_good) {
                ++scaled;
                for (std::size_t c = 0; c < 3; ++c) d[c] /= length;
                d[3] = d[3] < 0 ? -1 : 1;
            }
            for (std::size_t c = 0; c < width; ++c) store(floats.data, v * width + c, static_cast<float>(d[c]));
        }
        if (scaled + made == 0) return;  // keeps the original bits
        a = std::move(floats);
        if (scaled > 0)
            notes_.push_back(fmt::format("{}: {} were not of unit length and were made so", a.name, scaled));
        if (made > 0) {
            notes_.push_back(fmt::format("{}: {} without a direction {}", a.name, made,
                                         is_normal ? "were made from the triangles" : "became (1, 0, 0)"));
        }
    }

    std::vector<float> triangle_normals() const {
        Mesh bare;
        bare.vertex_count = mesh_.vertex_count;
        bare.indices = mesh_.indices;
        bare.attributes.push_back(mesh_.attributes.front());
        return normals_f32(bare);
    }

    /// Are the values in the range that glTF requires? Colors must be in [0, 1].
    static bool values_allowed(const Attribute& a) {
        if (!has_numbered_name(a.name, "COLOR_") || a.type != ComponentType::f32) return true;
        for (std::size_t i = 0; i * sizeof(float) < a.data.size(); ++i) {
            const auto value = load<float>(a.data, i);
            if (value < 0 || value > 1) return false;
        }
        return true;
    }

    /// Renames attributes that break glTF's rules: numbers count from 0 without gaps, and JOINTS_n and WEIGHTS_n come
    /// in pairs.
    void rename_lonely(const std::set<std::string>& known) {
        for (const char* prefix : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"}) {
            const std::string_view name = prefix;
            const bool paired = name == "JOINTS_" || name == "WEIGHTS_";
            std::size_t count = 0;
            const auto has = [&](std::string_view kind) {
                return known.contains(std::string(kind) + std::to_string(count));
            };
            while (paired ? has("JOINTS_") && has("WEIGHTS_") : has(name)) ++count;
            for (Attribute& a : out_.attributes) {
                if (!has_numbered_name(a.name, name) || std::stoul(a.name.substr(name.size())) < count) continue;
                renamed_.push_back(a.name);
                a.name.insert(0, 1, '_');
            }
        }
    }

    const Mesh& mesh_;
    WriteNotes& notes_;
    GltfAttributes out_;
    std::vector<std::string> left_out_, renamed_;
};

}  // namespace

Result<GltfAttributes> fit_to_gltf(const Mesh& mesh, WriteNotes& notes) {
    return Fitter(mesh, notes).run();
}

}  // namespace lacedring::detail
