#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>

#include "lacedring/file.hpp"
#include "lacedring/mesh_files.hpp"
#include "lrcore/base/try.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/mesh/text_scanner.h"

namespace lacedring {
namespace detail {

std::string shown(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string out = "'";
    for (const char c : text.substr(0, longest)) out += (c >= ' ' && c <= '~') ? c : '?';
    if (text.size() > longest) out += "...";
    return out + "'";
}

std::string shown_names(std::span<const std::string> names) {
    constexpr std::size_t kMost = 8;
    std::string out;
    for (std::size_t i = 0; i < names.size() && i < kMost; ++i) out += (i == 0 ? "" : ", ") + shown(names[i]);
    if (names.size() > kMost) out += fmt::format(" and {} more", names.size() - kMost);
    return out;
}

Attribute float_attribute(std::string name, std::uint8_t components, std::span<const float> values) {
    Attribute out{std::move(name), ComponentType::f32, components, false, {}};
    const std::span<const std::byte> bytes = std::as_bytes(values);
    out.data.assign(bytes.begin(), bytes.end());
    return out;
}

bool is_underflow(std::string_view word) {
    // A number out of range is far from 1: it is an underflow if its first nonzero digit, after applying the exponent,
    // is after the decimal point.
    const std::size_t mark = std::min(word.find_first_of("eE"), word.size());
    const std::string_view digits = word.substr(0, mark);
    long exponent = 0;
    if (mark < word.size() && !parse_number(word.substr(mark + 1), exponent)) {
        return word[mark + 1] == '-';  // the exponent itself is out of range
    }
    const std::size_t point = std::min(digits.find('.'), digits.size());
    const std::size_t first = digits.find_first_of("123456789");
    if (first == std::string_view::npos) return true;
    const long place = first < point ? static_cast<long>(point - first) : -static_cast<long>(first - point);
    return exponent < -place;
}

namespace {

template <class Real>
std::size_t first_not_finite(std::span<const std::byte> data) {
    for (std::size_t i = 0; i * sizeof(Real) < data.size(); ++i) {
        Real value{};
        std::memcpy(&value, data.data() + i * sizeof(Real), sizeof(Real));
        if (!std::isfinite(value)) return i;
    }
    return SIZE_MAX;
}

}  // namespace

Result<Mesh> checked(Mesh mesh) {
    if (mesh.indices.empty()) return malformed("has no triangles");
    const Attribute& position = mesh.attributes.front();
    const std::size_t bad = position.type == ComponentType::f64 ? first_not_finite<double>(position.data)
                                                                : first_not_finite<float>(position.data);
    if (bad != SIZE_MAX) return malformed("vertex {}: the position is not finite", bad / 3);
    if (position.type == ComponentType::f64) {
        for (std::size_t i = 0; i * sizeof(double) < position.data.size(); ++i) {
            double value = 0;
            std::memcpy(&value, position.data.data() + i * sizeof(double), sizeof(double));
            // From this value on, rounding to float gives infinity.
            if (std::abs(value) < 0x1.ffffffp127) continue;
            return malformed("vertex {}: the position is beyond the range of floats", i / 3);
        }
    }
    return mesh;
}

namespace {

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

/// The format by signature, else by extension; `any` if neither is known.
MeshFormat format_by_content(std::string_view raw, std::string_view text, const std::filesystem::path& name) {
    // Signatures first: files with the wrong extension are common.
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (raw.starts_with("glTF") || (start != std::string_view::npos && text[start] == '{')) return MeshFormat::gltf;
    if (text.starts_with("ply\n") || text.starts_with("ply\r")) return MeshFormat::ply;
    if (looks_like_stl(raw)) return MeshFormat::stl;
    if (looks_like_off(text)) return MeshFormat::off;
    const std::string extension = lower_extension(name);
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".off") return MeshFormat::off;
    if (extension == ".stl") return MeshFormat::stl;
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".gltf" || extension == ".glb") return MeshFormat::gltf;
    return MeshFormat::any;
}

/// A file with and without its byte-order mark, and its format.
struct Recognized {
    std::string_view raw, text;
    MeshFormat format = MeshFormat::any;

    std::span<const std::byte> text_bytes() const { return std::as_bytes(std::span(text)); }
};

Result<Recognized> recognize(std::span<const std::byte> bytes, Reading& reading) {
    Recognized out;
    out.raw = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    out.text = detail::without_byte_order_mark(out.raw);
    if (out.raw.empty()) return malformed("is empty");
    out.format = reading.options.format;
    if (out.format == MeshFormat::any) out.format = format_by_content(out.raw, out.text, reading.name);
    reading.report.format = out.format;
    return out;
}

Result<Mesh> read_bytes(std::span<const std::byte> bytes, Reading& reading) {
    LR_ASSIGN(const Recognized file, recognize(bytes, reading));
    const auto& [raw, text, format] = file;
    switch (format) {
        case MeshFormat::gltf:
            return read_gltf(file.text_bytes(), reading);
        case MeshFormat::obj:
            return read_obj(text, reading);
        case MeshFormat::off:
            return read_off(text, reading);
        case MeshFormat::ply:
            return read_ply(text, reading);
        case MeshFormat::stl:
            return read_stl(raw, reading);
        case MeshFormat::any:
            break;
    }
    return unsupported("the format is not recognized (glTF, GLB, OBJ, PLY, OFF and STL are read)");
}

}  // namespace

void Reading::leave_out(std::uint64_t count, std::string_view one, std::string_view many) {
    if (count != 0) report.left_out.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
}

Result<void> Reading::check_memory(double vertices, double stride, double triangles, double file_bytes) const {
    constexpr double kAlways = 512.0 * 1024 * 1024, kTimes = 128;
    const double most =
        options.max_bytes != 0 ? static_cast<double>(options.max_bytes) : std::max(kAlways, kTimes * file_bytes);
    const double bytes =
        vertices * stride + triangles * (12.0 + options.triangle_bytes) + static_cast<double>(options.held_bytes);
    if (bytes <= most) return {};
    constexpr double kMebibyte = 1024.0 * 1024;
    const std::string what =
        triangles == 0 ? "what is in the file takes" : fmt::format("{:.0f} triangles take", triangles);
    return Error{ErrorCode::memory_limit, fmt::format("{} about {:.0f} MiB, and {:.0f} MiB are allowed", what,
                                                      bytes / kMebibyte, most / kMebibyte)};
}

}  // namespace detail

Result<Mesh> read_mesh(std::span<const std::byte> bytes, const std::filesystem::path& name, const ReadOptions& options,
                       ReadReport* report, Materials* materials) {
    ReadReport unwanted;
    detail::Reading reading{options, report != nullptr ? *report : unwanted, name, materials};
    return detail::caught([&]() -> Result<Mesh> {
        Result<Mesh> mesh = detail::read_bytes(bytes, reading);
        // read_gltf has checked the memory itself, counting the bytes of all its files.
        if (!mesh || reading.report.format == MeshFormat::gltf) return mesh;
        double stride = 0;
        for (const Attribute& attribute : mesh->attributes) stride += static_cast<double>(attribute.stride());
        LR_TRY(reading.check_memory(mesh->vertex_count, stride, static_cast<double>(mesh->triangle_count()),
                                    static_cast<double>(bytes.size())));
        return mesh;
    });
}

Result<Mesh> read_mesh(const std::filesystem::path& path, const ReadOptions& options, ReadReport* report,
                       Materials* materials) {
    return detail::caught([&]() -> Result<Mesh> {
        LR_ASSIGN(const auto bytes, read_file(path));
        return read_mesh(bytes, path, options, report, materials);
    });
}

Result<PrimitiveList> read_primitives(std::span<const std::byte> bytes, const std::filesystem::path& name,
                                      const ReadOptions& options, ReadReport* report) {
    ReadReport unwanted;
    detail::Reading reading{options, report != nullptr ? *report : unwanted, name};
    return detail::caught([&]() -> Result<PrimitiveList> {
        LR_ASSIGN(const auto file, detail::recognize(bytes, reading));
        if (file.format == MeshFormat::gltf) return detail::read_gltf_primitives(file.text_bytes(), reading);
        LR_ASSIGN(Mesh mesh, read_mesh(bytes, name, options, &reading.report));
        PrimitiveList out;
        out.primitives.push_back({0, 0, PrimitiveMode::triangles, std::move(mesh)});
        out.placed.push_back({});
        out.mesh_names.emplace_back();
        return out;
    });
}

Result<PrimitiveList> read_primitives(const std::filesystem::path& path, const ReadOptions& options,
                                      ReadReport* report) {
    return detail::caught([&]() -> Result<PrimitiveList> {
        LR_ASSIGN(const auto bytes, read_file(path));
        return read_primitives(bytes, path, options, report);
    });
}

}  // namespace lacedring
