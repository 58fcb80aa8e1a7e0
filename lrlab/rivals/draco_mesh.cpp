// Encodes and decodes whole meshes with Draco.

#include "lrlab/rivals/whole_mesh.h"

#ifdef LACEDRING_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/draco_version.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>

#include "lrcore/base/try.h"
#include "lrcore/codec/vertices/quantize.h"
#include "lrlab/rivals/limit.h"
#endif

namespace lacedring {

#ifdef LACEDRING_DRACO

namespace {

/// An attribute for Draco: floats if Draco quantizes it, else the mesh's values.
struct DracoInput {
    const Attribute* attribute = nullptr;
    std::uint32_t bits = 0;     // 0: lossless
    std::vector<float> floats;  // empty if lossless
};

double number(const Attribute& attribute, std::size_t i) {
    if (attribute.type == ComponentType::f64) {
        double out = 0;
        std::memcpy(&out, attribute.data.data() + i * sizeof out, sizeof out);
        return out;
    }
    float out = 0;
    std::memcpy(&out, attribute.data.data() + i * sizeof out, sizeof out);
    return static_cast<double>(out);
}

DracoInput input_of(const Attribute& attribute, const AttributeBits& bits) {
    DracoInput out{&attribute, 0, {}};
    if (!quantized(attribute, bits)) return out;
    out.bits = vertex_options(attribute, bits).bits;
    out.floats.resize(attribute.data.size() / size_of(attribute.type));
    for (std::size_t i = 0; i < out.floats.size(); ++i) out.floats[i] = static_cast<float>(number(attribute, i));
    return out;
}

draco::GeometryAttribute::Type type_of(std::string_view name) {
    if (name == "POSITION") return draco::GeometryAttribute::POSITION;
    if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
    if (name.starts_with("TEXCOORD_")) return draco::GeometryAttribute::TEX_COORD;
    if (name.starts_with("COLOR_")) return draco::GeometryAttribute::COLOR;
    return draco::GeometryAttribute::GENERIC;
}

draco::DataType type_of(ComponentType type) {
    constexpr draco::DataType kTypes[] = {draco::DT_INT8,  draco::DT_UINT8,  draco::DT_INT16,   draco::DT_UINT16,
                                          draco::DT_INT32, draco::DT_UINT32, draco::DT_FLOAT32, draco::DT_FLOAT64};
    return kTypes[static_cast<std::size_t>(type)];
}

void add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data, std::size_t components,
                   bool normalized, std::span<const std::byte> values) {
    const std::size_t stride = values.size() / mesh.num_points();
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), data, normalized,
                   static_cast<std::int64_t>(stride), 0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    mesh.attribute(id)->buffer()->Write(0, values.data(), values.size());
}

/// Converts the mesh; its attributes get the unique ids 0, 1, ... `numbered`: adds an attribute with the vertices'
/// numbers.
std::unique_ptr<draco::Mesh> draco_mesh(const Mesh& mesh, const std::vector<DracoInput>& inputs, bool numbered) {
    auto out = std::make_unique<draco::Mesh>();
    out->SetNumFaces(mesh.triangle_count());
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const std::uint32_t* v = mesh.indices.data() + std::size_t{3} * t;
        out->SetFace(draco::FaceIndex(t), {draco::PointIndex(v[0]), draco::PointIndex(v[1]), draco::PointIndex(v[2])});
    }
    out->set_num_points(mesh.vertex_count);
    for (const DracoInput& input : inputs) {
        const Attribute& a = *input.attribute;
        if (input.bits != 0) {
            add_attribute(*out, type_of(a.name), draco::DT_FLOAT32, a.components, false,
                          std::as_bytes(std::span(input.floats)));
        } else {
            add_attribute(*out, type_of(a.name), type_of(a.type), a.components, a.normalized, a.data);
        }
    }
    if (numbered) {
        std::vector<std::uint32_t> numbers(mesh.vertex_count);
        for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) numbers[v] = v;
        add_attribute(*out, draco::GeometryAttribute::GENERIC, draco::DT_UINT32, 1, false,
                      std::as_bytes(std::span(numbers)));
    }
    out->DeduplicateAttributeValues();
    out->DeduplicatePointIds();
    return out;
}

struct Coded {
    draco::EncoderBuffer bytes;
    std::unique_ptr<draco::Mesh> decoded;
};

/// `level`: the compression level of Draco's tools, 0 to 10; 10 gives the smallest files.
Result<draco::EncoderBuffer> encode_draco_at(const draco::Mesh& mesh, const std::vector<DracoInput>& inputs,
                                             int level) {
    draco::ExpertEncoder encoder(mesh);
    encoder.SetSpeedOptions(10 - level, 10 - level);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (inputs[i].bits != 0)
            encoder.SetAttributeQuantization(static_cast<int>(i), static_cast<int>(inputs[i].bits));
    }
    draco::EncoderBuffer out;
    if (const draco::Status status = encoder.EncodeToBuffer(&out); !status.ok()) {
        return Error{ErrorCode::unsupported, "Draco: " + status.error_msg_string()};
    }
    return out;
}

Result<Coded> encode_draco(const draco::Mesh& mesh, const std::vector<DracoInput>& inputs) {
    LR_ASSIGN(draco::EncoderBuffer bytes, encode_draco_at(mesh, inputs, 10));
    Coded out{std::move(bytes), nullptr};
    draco::DecoderBuffer buffer;
    buffer.Init(out.bytes.data(), out.bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return Error{ErrorCode::unsupported, "Draco: " + decoded.status().error_msg_string()};
    out.decoded = std::move(decoded).value();
    if (out.decoded->num_faces() != mesh.num_faces()) {
        return Error{ErrorCode::unsupported,
                     fmt::format("Draco gives back {} of {} triangles", out.decoded->num_faces(), mesh.num_faces())};
    }
    return out;
}

/// Compares a decoded numbered mesh with the original: checks triangles and lossless values, and sets the largest
/// errors of quantized values.
void compare(const draco::Mesh& decoded, const Mesh& mesh, const std::vector<DracoInput>& inputs, RivalMesh& out) {
    const auto values_of = [&](std::size_t unique_id, draco::PointIndex point) {
        return decoded.GetAttributeByUniqueId(static_cast<std::uint32_t>(unique_id))->GetAddressOfMappedIndex(point);
    };
    std::vector<std::uint32_t> vertex(decoded.num_points()), indices;
    for (std::uint32_t p = 0; p < decoded.num_points(); ++p) {
        std::memcpy(&vertex[p], values_of(inputs.size(), draco::PointIndex(p)), sizeof vertex[p]);
        if (vertex[p] >= mesh.vertex_count) {
            out.invalid = "vertices decoded differ";
            return;
        }
    }
    for (std::uint32_t f = 0; f < decoded.num_faces(); ++f) {
        for (const draco::PointIndex& p : decoded.face(draco::FaceIndex(f))) indices.push_back(p.value());
    }
    if (oriented_triangles(indices, vertex) != oriented_triangles(mesh.indices, {}))
        out.invalid = "triangles decoded differ";
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Attribute& attribute = *inputs[i].attribute;
        const std::size_t n = attribute.components;
        double largest = 0;
        for (std::uint32_t p = 0; p < decoded.num_points(); ++p) {
            const std::uint8_t* at = values_of(i, draco::PointIndex(p));
            if (inputs[i].bits == 0) {
                const std::byte* given = attribute.data.data() + vertex[p] * attribute.stride();
                if (std::memcmp(at, given, attribute.stride()) != 0) out.invalid = attribute.name + " decoded differs";
                continue;
            }
            for (std::size_t c = 0; c < n; ++c) {
                float value = 0;
                std::memcpy(&value, at + c * sizeof value, sizeof value);
                largest =
                    std::max(largest, std::abs(static_cast<double>(value) - number(attribute, vertex[p] * n + c)));
            }
        }
        out.largest_errors.push_back(largest);
    }
}

}  // namespace

Result<RivalMesh> encode_draco_mesh(const Mesh& mesh, const AttributeBits& bits) {
    LR_TRY(check_valences(mesh.indices, mesh.vertex_count, "Draco"));
    std::vector<DracoInput> inputs;
    for (const Attribute& attribute : mesh.attributes) inputs.push_back(input_of(attribute, bits));
    LR_ASSIGN(Coded coded, encode_draco(*draco_mesh(mesh, inputs, false), inputs));
    RivalMesh out;
    const auto* const begin = reinterpret_cast<const std::byte*>(coded.bytes.data());
    out.bytes.assign(begin, begin + coded.bytes.size());
    LR_ASSIGN(const Coded numbered, encode_draco(*draco_mesh(mesh, inputs, true), inputs));
    compare(*numbered.decoded, mesh, inputs, out);
    return out;
}

Result<std::vector<std::byte>> draco_bytes(const Mesh& mesh, const AttributeBits& bits, int level) {
    LR_TRY(check_valences(mesh.indices, mesh.vertex_count, "Draco"));
    std::vector<DracoInput> inputs;
    for (const Attribute& attribute : mesh.attributes) inputs.push_back(input_of(attribute, bits));
    LR_ASSIGN(const draco::EncoderBuffer coded, encode_draco_at(*draco_mesh(mesh, inputs, false), inputs, level));
    const auto* const begin = reinterpret_cast<const std::byte*>(coded.data());
    return std::vector<std::byte>(begin, begin + coded.size());
}

Result<DecodedRival> decode_draco(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    const auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) return Error{ErrorCode::malformed, "Draco: " + mesh.status().error_msg_string()};
    const draco::Mesh& decoded = *mesh.value();
    DecodedRival out;
    out.indices.resize(std::size_t{3} * decoded.num_faces());
    for (std::uint32_t f = 0; f < decoded.num_faces(); ++f) {
        const draco::Mesh::Face& face = decoded.face(draco::FaceIndex(f));
        for (std::size_t k = 0; k < 3; ++k) out.indices[3 * std::size_t{f} + k] = face[k].value();
    }
    for (int i = 0; i < decoded.num_attributes(); ++i) {
        const draco::PointAttribute& from = *decoded.attribute(i);
        const auto stride = static_cast<std::size_t>(from.byte_stride());
        std::vector<std::byte>& to = out.attributes.emplace_back(decoded.num_points() * stride);
        if (from.is_mapping_identity()) {
            std::memcpy(to.data(), from.GetAddress(draco::AttributeValueIndex(0)), to.size());
            continue;
        }
        for (std::uint32_t p = 0; p < decoded.num_points(); ++p) {
            std::memcpy(to.data() + p * stride, from.GetAddressOfMappedIndex(draco::PointIndex(p)), stride);
        }
    }
    return out;
}

std::string draco_version() {
    return draco::kDracoVersion;
}

#else

Result<RivalMesh> encode_draco_mesh(const Mesh& /*mesh*/, const AttributeBits& /*bits*/) {
    return Error{ErrorCode::unsupported, "built without libdraco"};
}

Result<std::vector<std::byte>> draco_bytes(const Mesh& /*mesh*/, const AttributeBits& /*bits*/, int /*level*/) {
    return Error{ErrorCode::unsupported, "built without libdraco"};
}

Result<DecodedRival> decode_draco(std::span<const std::byte> /*bytes*/) {
    return Error{ErrorCode::unsupported, "built without libdraco"};
}

std::string draco_version() {
    return {};
}

#endif

}  // namespace lacedring
