#include "renderer/expander.h"

#include "lacedring/streams.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/try.h"

namespace lacedring::gpu {

Result<Expander> Expander::create(Context& context) {
    Expander out;
    out.context_ = &context;
    LR_ASSIGN(out.lean_, LeanDecoder::create(context));
    LR_ASSIGN(out.packed_, PackedDecoder::create(context));
    LR_ASSIGN(out.vertices_, VertexDecoder::create(context));
    LR_ASSIGN(out.seams_, SeamDecoder::create(context));
    LR_ASSIGN(out.rotator_, Rotator::create(context));
    return out;
}

Result<Drawable> Expander::upload(Transfer& transfer, const Model& model, Source source,
                                  const UploadOptions& options) const {
    Drawable out;
    out.descriptors = Descriptors(*context_);
    LR_ASSIGN(out.mesh, upload_mesh(*context_, transfer, model, source, options));
    if (!out.mesh.indices) return out;
    if (source == Source::lean) {
        LR_ASSIGN(const LeanView view, view_lean(model.lean.words));
        LR_ASSIGN(out.decode, lean_.plan(out.descriptors, out.mesh, view));
    } else if (is_packed(source)) {
        LR_ASSIGN(const PackedView view, view_packed(model.packed.words));
        LR_ASSIGN(out.decode, packed_.plan(out.descriptors, out.mesh, view));
    }
    if (const EncodedSeams* seams = seams_of(model, source)) {
        LR_ASSIGN(const SeamView view, view_seams(seams->words, out.mesh.slots, out.mesh.surface_vertices));
        LR_ASSIGN(out.seams, seams_.plan(out.descriptors, out.mesh, view));
    }
    if (options.path != Path::compute) return out;
    if (source == Source::packed_vertices) {
        LR_ASSIGN(const VertexView view, view_vertices(model.vertices.words));
        LR_ASSIGN(out.vertices, vertices_.plan(out.descriptors, out.mesh, view));
    }
    LR_ASSIGN(out.rotate, rotator_.plan(out.descriptors, out.mesh));
    return out;
}

void Expander::decode(VkCommandBuffer commands, Drawable& drawable, bool barrier) const {
    if (drawable.mesh.decoded || drawable.decode.dispatches.empty()) return;
    const Decoder& decoder = drawable.mesh.source == Source::lean ? static_cast<const Decoder&>(lean_) : packed_;
    decoder.record(commands, drawable.decode);
    vertices_.record(commands, drawable.vertices);
    seams_.record(commands, drawable.seams);
    seams_.record_positions(commands, drawable.seams);
    if (barrier) decode_barrier(commands);
    drawable.mesh.decoded = true;
    drawable.mesh.rotated = false;
}

void Expander::decode_vertices(VkCommandBuffer commands, const Drawable& drawable) const {
    vertices_.record(commands, drawable.vertices);
    seams_.record_positions(commands, drawable.seams);
    decode_barrier(commands);
}

void Expander::rotate(VkCommandBuffer commands, Drawable& drawable) const {
    if (drawable.mesh.rotated || drawable.mesh.path != Path::compute) return;
    rotator_.record(commands, drawable.rotate);
    decode_barrier(commands);
    drawable.mesh.rotated = true;
}

}  // namespace lacedring::gpu
