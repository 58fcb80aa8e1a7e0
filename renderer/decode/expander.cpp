#include "renderer/decode/expander.h"

#include "renderer/vk/try.h"

namespace lacedring::gpu {

namespace {

template <class Pass>
Result<void> make_pass(Context& context, std::optional<Pass>& pass) {
    if (pass) return {};
    LR_ASSIGN(pass, Pass::create(context));
    return {};
}

}  // namespace

Result<Expander> Expander::create(Context& context) {
    Expander out;
    out.context_ = &context;
    LR_ASSIGN(out.rotator_, Rotator::create(context));
    return out;
}

Result<Expander> Expander::again() const {
    LR_ASSIGN(Expander out, create(*context_));
    if (lean_) LR_TRY(make_pass(*context_, out.lean_));
    if (packed_) LR_TRY(make_pass(*context_, out.packed_));
    if (vertices_) LR_TRY(make_pass(*context_, out.vertices_));
    if (seams_) LR_TRY(make_pass(*context_, out.seams_));
    return out;
}

Result<ExpandedMesh> Expander::upload(Transfer& transfer, const Model& model, Source source,
                                      const UploadOptions& options) {
    ExpandedMesh out;
    out.descriptors = Descriptors(*context_);
    LR_ASSIGN(const StreamViews views, view_streams(model, source));
    LR_ASSIGN(out.mesh, upload_mesh({*context_, transfer, model, source, options, views}));
    if (!out.mesh.indices) return out;
    if (source == Source::lean) {
        LR_TRY(make_pass(*context_, lean_));
        LR_ASSIGN(out.decode, lean_->plan(out.descriptors, out.mesh, views.lean));
    } else if (is_packed(source)) {
        LR_TRY(make_pass(*context_, packed_));
        LR_ASSIGN(out.decode, packed_->plan(out.descriptors, out.mesh, views.packed));
    }
    if (out.mesh.copies) {
        LR_TRY(make_pass(*context_, seams_));
        LR_ASSIGN(out.seams, seams_->plan(out.descriptors, out.mesh, views.seams));
    }
    if (options.path != Path::compute) return out;
    if (source == Source::packed_vertices) {
        LR_TRY(make_pass(*context_, vertices_));
        LR_ASSIGN(out.vertices, vertices_->plan(out.descriptors, out.mesh, views.vertices));
    }
    LR_ASSIGN(out.rotate, rotator_.plan(out.descriptors, out.mesh));
    return out;
}

void Expander::decode(VkCommandBuffer commands, ExpandedMesh& expanded) const {
    if (expanded.mesh.decoded || expanded.decode.dispatches.empty()) return;
    const Decoder& decoder = expanded.mesh.source == Source::lean ? static_cast<const Decoder&>(*lean_) : *packed_;
    decoder.record(commands, expanded.decode);
    record_vertices(commands, expanded, true);
    decode_barrier(commands);
    expanded.mesh.decoded = true;
    expanded.mesh.rotated = false;
}

void Expander::decode_vertices(VkCommandBuffer commands, const ExpandedMesh& expanded) const {
    record_vertices(commands, expanded, false);
    decode_barrier(commands);
}

void Expander::record_vertices(VkCommandBuffer commands, const ExpandedMesh& expanded, bool seams) const {
    if (!expanded.vertices.dispatches.empty()) vertices_->record(commands, expanded.vertices);
    if (expanded.seams.triangles.dispatches.empty()) return;
    if (seams) seams_->record(commands, expanded.seams);
    seams_->record_positions(commands, expanded.seams);
}

void Expander::rotate(VkCommandBuffer commands, ExpandedMesh& expanded) const {
    if (expanded.mesh.rotated || expanded.mesh.path != Path::compute) return;
    rotator_.record(commands, expanded.rotate);
    decode_barrier(commands);
    expanded.mesh.rotated = true;
}

}  // namespace lacedring::gpu
