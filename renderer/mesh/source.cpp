#include "renderer/mesh/source.h"

#include "renderer/vk/try.h"

namespace lacedring::gpu {

bool has_source(const Model& model, Source source) {
    if (source == Source::packed_vertices && model.vertices.words.empty()) return false;
    return !is_packed(source) || !model.packed.words.empty();
}

const EncodedSeams* seams_of(const Model& model, Source source) {
    if (source == Source::plain || !model.surface.has_seams()) return nullptr;
    return source == Source::lean ? &model.lean_seams : &model.packed_seams;
}

std::uint64_t connectivity_bytes(const Model& model, Source source) {
    if (source == Source::plain) return 0;
    const EncodedSeams* seams = seams_of(model, source);
    return sizeof(std::uint32_t) * ((is_packed(source) ? model.packed.words : model.lean.words).size() +
                                    (seams == nullptr ? 0 : seams->words.size()));
}

std::uint64_t slots_of(const Model& model, Source source) {
    if (source == Source::plain) return model.triangle_count();
    return source == Source::lean ? model.lean.slot_triangle.size() : model.packed.triangle_order.size();
}

std::uint32_t vertices_of(const Model& model, Source source) {
    const EncodedSeams* seams = seams_of(model, source);
    return seams == nullptr ? model.vertex_count() : static_cast<std::uint32_t>(seams->copy_order.size());
}

Result<StreamViews> view_streams(const Model& model, Source source) {
    StreamViews out;
    const std::uint32_t vertices = model.surface.vertex_count;
    if (!model.lean.words.empty()) {
        LR_ASSIGN(out.lean, view_lean(model.lean.words));
    }
    if (source == Source::lean && (out.lean.vertices != vertices || model.lean.vertex_order.size() != vertices ||
                                   model.lean.slot_triangle.size() != out.lean.slots())) {
        return Error{ErrorCode::invalid_argument, "the lean stream is not of this mesh"};
    }
    if (is_packed(source)) {
        if (model.packed.words.empty())
            return Error{ErrorCode::invalid_argument, "the model was made without a packed stream"};
        LR_ASSIGN(out.packed, view_packed(model.packed.words));
        if (out.packed.vertices != vertices || model.packed.vertex_order.size() != vertices ||
            model.packed.triangle_order.size() != out.packed.triangles) {
            return Error{ErrorCode::invalid_argument, "the packed stream is not of this mesh"};
        }
    }
    if (const EncodedSeams* seams = seams_of(model, source)) {
        LR_ASSIGN(out.seams, view_seams(seams->words, static_cast<std::uint32_t>(slots_of(model, source)), vertices));
        if (out.seams.copies != seams->copy_order.size())
            return Error{ErrorCode::invalid_argument, "the seam section is not of this mesh"};
    }
    if (source != Source::packed_vertices) return out;
    if (model.vertices.words.empty())
        return Error{ErrorCode::invalid_argument, "the model was made without a vertex stream"};
    LR_ASSIGN(out.vertices, view_vertices(model.vertices.words));
    if (out.vertices.vertices != vertices || out.vertices.integers != 3 || out.vertices.type != ComponentType::f32 ||
        out.vertices.mapping == VertexMapping::octahedral) {
        return Error{ErrorCode::invalid_argument, "the vertex stream is not of this mesh's positions"};
    }
    return out;
}

}  // namespace lacedring::gpu
