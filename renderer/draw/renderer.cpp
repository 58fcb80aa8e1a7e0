#include "renderer/draw/renderer.h"

#include <algorithm>
#include <cstring>

#include "renderer/vk/try.h"

namespace lacedring::gpu {

Result<Renderer> Renderer::create(Context& context, const RendererOptions& options) {
    Renderer out;
    out.context_ = &context;
    out.options_ = options;
    LR_ASSIGN(out.commands_, Commands::create(context));
    LR_ASSIGN(out.transfer_, Transfer::create(context));
    LR_ASSIGN(out.target_, Target::create(context, {options.width, options.height}));
    LR_ASSIGN(out.painter_, Painter::create(context, options.view, options.samples));
    LR_ASSIGN(out.expander_, Expander::create(context));
    LR_ASSIGN(out.slots_, SlotReader::create(context));
    if (options.view == View::silhouette) {
        LR_ASSIGN(out.silhouettes_, Silhouettes::create(context));
        LR_ASSIGN(out.vertex_normals_, VertexNormals::create(context));
    }
    return out;
}

std::uint64_t Renderer::device_bytes(const Model& model, Source source, Path path) const {
    UploadOptions options = upload_options(options_.view);
    options.path = path;
    if (options_.view == View::material) options.materials.emplace();
    return mesh_bytes(model, source, options).all;
}

Result<Drawable> Renderer::upload(const Model& model, Source source, Path path) {
    UploadOptions options = upload_options(options_.view);
    options.path = path;
    options.max_range = options_.max_range;
    if (options_.view == View::material) {
        const std::pair wanted(model.materials_number, model.triangle_count());
        if (!materials_ || uploaded_materials_ != wanted) {
            LR_ASSIGN(materials_, upload_materials(*context_, *transfer_, model.materials, wanted.second));
            uploaded_materials_ = wanted;
        }
        options.materials = materials_->table.address_words();
    }
    std::optional<Adjacency> adjacency;
    std::vector<float> normals;
    if (vertex_normals_) {
        LR_ASSIGN(adjacency, upload_adjacency(*context_, *transfer_, model));
        LR_ASSIGN(normals, normals_of(*adjacency, model));
        options.normals = normals;
    }
    LR_ASSIGN(ExpandedMesh expanded, expander_.upload(*transfer_, model, source, options));
    Drawable out{std::move(expanded), {}, std::move(adjacency)};
    LR_ASSIGN(out.draw, painter_.plan(out.descriptors, out.mesh, target_));
    return out;
}

Result<std::vector<float>> Renderer::normals_of(const Adjacency& adjacency, const Model& model) {
    LR_ASSIGN(const Buffer buffer, vertex_normals_->compute(*commands_, adjacency));
    std::vector<float> by_table(std::size_t{3} * adjacency.vertices);
    LR_TRY(transfer_->read(buffer, 0, std::as_writable_bytes(std::span(by_table))));
    std::vector<float> out(model.positions.size());
    for (std::size_t v = adjacency.vertices; v-- > 0;) {
        std::copy_n(&by_table[3 * v], 3, &out[3 * std::size_t{adjacency.vertex_order[v]}]);
    }
    if (!model.surface.has_seams()) return out;
    const std::vector<std::uint32_t> of_surface = first_vertices(model.surface);
    for (std::size_t v = 0; v < model.surface.vertex_of.size(); ++v) {
        std::copy_n(&out[3 * std::size_t{of_surface[model.surface.vertex_of[v]]}], 3, &out[3 * v]);
    }
    return out;
}

void Renderer::decode(VkCommandBuffer commands, Drawable& drawable) const {
    expander_.decode(commands, drawable);
}

Result<Picture> Renderer::draw(Drawable& drawable, const Model& model, const Camera& camera, bool exact) {
    if (!exact && drawable.mesh.rotated) {
        return Error{ErrorCode::invalid_argument, "the triangles are rotated already: draw the raw pictures first"};
    }
    painter_.set_frame(model, camera, target_);
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    decode(commands, drawable);
    if (exact) expander_.rotate(commands, drawable);
    painter_.record(commands, drawable.mesh, drawable.draw, target_,
                    exact ? Painter::Ties::by_number : Painter::Ties::first_drawn);
    if (silhouettes_) {
        silhouettes_->set_frame(camera, target_,
                                {.crease = options_.crease, .width = 1.5F * static_cast<float>(options_.samples)});
        silhouettes_->record(commands, *drawable.adjacency, target_);
    }
    target_.record_read(commands);
    LR_TRY(commands_->run());
    return target_.picture();
}

Result<std::vector<std::uint32_t>> Renderer::read_indices(Drawable& drawable) {
    if (drawable.mesh.path != Path::compute) return slots_.read(*commands_, *transfer_, drawable.mesh);
    return read_decoded(drawable, drawable.mesh.indices);
}

Result<std::vector<std::uint32_t>> Renderer::read_copies(Drawable& drawable) {
    if (!drawable.mesh.copies) return std::vector<std::uint32_t>();
    return read_decoded(drawable, drawable.mesh.copies);
}

Result<std::vector<std::uint32_t>> Renderer::read_decoded(Drawable& drawable, const Buffer& indices) {
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    decode(commands, drawable);
    LR_TRY(commands_->run());
    std::vector<std::uint32_t> out(std::size_t{3} * drawable.mesh.slots);
    LR_TRY(transfer_->read(indices, 0, std::as_writable_bytes(std::span(out))));
    return out;
}

Result<std::vector<std::uint32_t>> Renderer::read_positions(Drawable& drawable) {
    const GpuMesh& mesh = drawable.mesh;
    if (mesh.source != Source::packed_vertices || mesh.path != Path::compute) {
        return slots_.positions(*commands_, *transfer_, mesh);
    }
    LR_ASSIGN(const VkCommandBuffer commands, commands_->begin());
    decode(commands, drawable);
    LR_TRY(commands_->run());
    std::vector<Vertex> vertices(mesh.vertex_count);
    LR_TRY(transfer_->read(mesh.vertices, 0, std::as_writable_bytes(std::span(vertices))));
    std::vector<std::uint32_t> out(std::size_t{3} * mesh.vertex_count);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        std::memcpy(&out[3 * v], vertices[v].position, sizeof(vertices[v].position));
    }
    return out;
}

Result<WordsRead> Renderer::words_read(const Drawable& drawable) {
    return slots_.words_read(*commands_, *transfer_, drawable.mesh);
}

}  // namespace lacedring::gpu
