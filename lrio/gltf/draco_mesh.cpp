#include "lrio/gltf/draco_mesh.h"

#ifdef LACEDRING_DRACO
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <cstring>
#include <exception>
#include <new>

#include "lrio/mesh/read_formats.h"
#endif

namespace lacedring::detail {

bool has_draco() {
#ifdef LACEDRING_DRACO
    return true;
#else
    return false;
#endif
}

#ifdef LACEDRING_DRACO

namespace {

/// The counts at the beginning of the connectivity. Draco allocates memory for them before it decodes.
struct Claim {
    std::uint32_t faces = 0;
    std::uint32_t points = 0;  // Edgebreaker: vertices, split ones counted twice
    std::uint8_t tables = 0;   // Edgebreaker: attributes with their own connectivity
};

bool peek_claim(draco::DecoderBuffer buffer, bool is_edgebreaker, Claim& out) {
    if (!is_edgebreaker) return draco::DecodeVarint(&out.faces, &buffer) && draco::DecodeVarint(&out.points, &buffer);
    std::uint32_t symbols = 0, splits = 0;
    const bool read = draco::DecodeVarint(&out.points, &buffer) && draco::DecodeVarint(&out.faces, &buffer) &&
                      buffer.Decode(&out.tables) && draco::DecodeVarint(&symbols, &buffer) &&
                      draco::DecodeVarint(&splits, &buffer);
    constexpr std::uint32_t kMost = 0x3fffffff;  // Draco adds them as signed integers
    if (!read || out.points > kMost || splits > kMost || splits > out.faces) return false;
    out.points += splits;
    return true;
}

/// Draco's decoder that checks the memory limit before it allocates memory for counts in the data.
template <class Decoder, bool is_edgebreaker>
class BoundedDecoder : public Decoder {
  public:
    explicit BoundedDecoder(GltfFile& file) : file_(file) {}
    Result<void> refused;

  protected:
    bool DecodeGeometryData() override {
        Claim claim;
        if (!peek_claim(*this->buffer(), is_edgebreaker, claim)) return false;
        // Upper bounds of the bytes that Draco 1.5 allocates. Per face and point: corner table, points of corners,
        // faces, lists of corners. Per attribute's table: vertices and seams of corners.
        constexpr double kFace = 80, kPoint = 24, kTableFace = 40, kTablePoint = 16;
        return take(claim.faces * (kFace + kTableFace * claim.tables) +
                    claim.points * (kPoint + kTablePoint * claim.tables)) &&
               Decoder::DecodeGeometryData();
    }

    bool DecodeAllAttributes() override {
        // The attributes are known here, but their values are not allocated yet. Draco allocates for each attribute the
        // decoded values, the 32-bit integers that they are decoded from, and a value index per point; for each
        // attribute decoder, an order of the points.
        double point_bytes = 16.0 * this->num_attributes_decoders();
        for (int i = 0; i < this->point_cloud()->num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *this->point_cloud()->attribute(i);
            point_bytes += 4 + attribute.num_components() * (4.0 + draco::DataTypeLength(attribute.data_type()));
        }
        return take(this->point_cloud()->num_points() * point_bytes) && Decoder::DecodeAllAttributes();
    }

  private:
    bool take(double bytes) {
        bytes_ += bytes;
        refused = file_.take_memory(0, bytes_);
        return refused.has_value();
    }

    GltfFile& file_;
    double bytes_ = 0;
};

template <class Decoder>
Result<std::unique_ptr<draco::Mesh>> decode_by(Decoder decoder, draco::DecoderBuffer& buffer) {
    auto mesh = std::make_unique<draco::Mesh>();
    const draco::DecoderOptions options;
    try {
        const draco::Status status = decoder.Decode(options, &buffer, mesh.get());
        if (!decoder.refused) return decoder.refused.error();
        if (!status.ok()) return malformed("{}", shown(status.error_msg_string()));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) {
        return malformed("{}", shown(exception.what()));
    }
    return mesh;
}

}  // namespace

Result<std::unique_ptr<draco::Mesh>> decode_draco_mesh(GltfFile& file, std::span<const std::byte> data) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) return malformed("the data has no header");
    if (header.version_major != 2 || header.version_minor != 2) {
        return unsupported("bitstream version {}.{} is not read", header.version_major, header.version_minor);
    }
    if (header.encoder_type != draco::TRIANGULAR_MESH) return malformed("the data is not a mesh");
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        return decode_by(BoundedDecoder<draco::MeshEdgebreakerDecoder, true>(file), buffer);
    }
    if (header.encoder_method != draco::MESH_SEQUENTIAL_ENCODING) {
        return unsupported("encoding method {} is not read", header.encoder_method);
    }
    return decode_by(BoundedDecoder<draco::MeshSequentialDecoder, false>(file), buffer);
}

namespace {

template <class T>
Result<void> copy_points(const draco::Mesh& mesh, std::span<std::byte> out) {
    std::size_t at = 0;
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(f))) {
            const auto index = static_cast<T>(point.value());
            if (point.value() >= mesh.num_points() || index != point.value()) {
                return malformed("index {} of {} points is out of range", point.value(), mesh.num_points());
            }
            std::memcpy(out.data() + at, &index, sizeof index);
            at += sizeof index;
        }
    }
    return {};
}

template <class T>
Result<void> copy_values(const draco::PointAttribute& from, std::uint32_t points, std::span<std::byte> out) {
    const auto components = static_cast<std::size_t>(from.num_components());
    const auto stride = static_cast<std::size_t>(from.byte_stride());
    const std::size_t held = from.buffer() == nullptr || stride == 0 ? 0 : from.buffer()->data_size() / stride;
    const bool has_all = from.is_mapping_identity() || from.indices_map_size() >= points;
    if (!has_all) return malformed("not every point has a value");
    std::vector<T> value(components);
    for (std::uint32_t p = 0; p < points; ++p) {
        const draco::AttributeValueIndex index = from.mapped_index(draco::PointIndex(p));
        if (index.value() >= held || !from.ConvertValue<T>(index, value.data())) {
            return malformed("point {} has no value that fits", p);
        }
        std::memcpy(out.data() + p * components * sizeof(T), value.data(), components * sizeof(T));
    }
    return {};
}

}  // namespace

Result<void> copy_draco_indices(const draco::Mesh& mesh, ComponentType type, std::span<std::byte> out) {
    if (type == ComponentType::u8) return copy_points<std::uint8_t>(mesh, out);
    if (type == ComponentType::u16) return copy_points<std::uint16_t>(mesh, out);
    if (type == ComponentType::u32) return copy_points<std::uint32_t>(mesh, out);
    return malformed("the indices are not unsigned");
}

Result<void> copy_draco_attribute(const draco::Mesh& mesh, std::uint32_t unique_id, ComponentType type, int components,
                                  std::span<std::byte> out) {
    const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(unique_id);
    if (from == nullptr) return malformed("attribute {} does not exist", unique_id);
    if (from->num_components() != components) {
        return malformed("attribute {} has {} components, the accessor {}", unique_id, from->num_components(),
                         components);
    }
    const bool is_real = from->data_type() == draco::DT_FLOAT32 || from->data_type() == draco::DT_FLOAT64;
    if (is_real && type != ComponentType::f32) return malformed("attribute {} has floats, the accessor not", unique_id);
    switch (type) {
        case ComponentType::i8:
            return copy_values<std::int8_t>(*from, mesh.num_points(), out);
        case ComponentType::u8:
            return copy_values<std::uint8_t>(*from, mesh.num_points(), out);
        case ComponentType::i16:
            return copy_values<std::int16_t>(*from, mesh.num_points(), out);
        case ComponentType::u16:
            return copy_values<std::uint16_t>(*from, mesh.num_points(), out);
        case ComponentType::u32:
            return copy_values<std::uint32_t>(*from, mesh.num_points(), out);
        case ComponentType::f32:
            return copy_values<float>(*from, mesh.num_points(), out);
        default:
            return malformed("the accessor's type");
    }
}

#endif

}  // namespace lacedring::detail
