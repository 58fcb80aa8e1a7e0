// Structs and constants shared by C++ and GLSL. Structs have the same layout under std140 and in C++.
#ifndef LACEDRING_SHADERS_SHARED_H
#define LACEDRING_SHADERS_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstdint>
namespace lacedring::gpu {
using uint = std::uint32_t;
using uvec2 = std::array<std::uint32_t, 2>;
using uvec4 = std::array<std::uint32_t, 4>;
using vec4 = std::array<float, 4>;
using mat4 = std::array<float, 16>;  // column-major
#endif

// 4 triangles are 12 indices: three 16-byte stores. These wide stores make the decoder fast.
#define LR_TRIANGLES_PER_INVOCATION 4u
#define LR_COMPUTE_GROUP 128u  // workgroup size; every Vulkan device supports 128

// Specialization constants of the decoders:
#define LR_CONSTANT_BLOCKS 1      // packed_decode.comp: blocks per workgroup
#define LR_CONSTANT_COMPONENTS 0  // vertex_decode.comp: integers per vertex
#define LR_CONSTANT_INTEGERS 1    // vertex_decode.comp: writes the integers, not the values they map to
#define LR_CONSTANT_MAPPING 2     // vertex_decode.comp: mapping from integers to values (LR_MAPPING_*)

#define LR_CONSTANT_SEAM_PASS 0  // seam_decode.comp: LR_SEAM_PASS_*

// lean_decode.comp, packed_decode.comp: one dispatch expands `slots` slots from `first_slot` on. Its descriptors cover
// only the parts of the buffers that these slots need.
struct DecodeConstants {
    uint first_slot;  // a multiple of LR_TRIANGLES_PER_INVOCATION (lean) or LR_PACKED_BLOCK (packed)
    uint slots;       // slots of this dispatch
    uint draws;       // draw commands to write: 0 in every dispatch but one
    uint draw_slots;  // slots of each draw command but the last
    uint first_word;  // lean: word of the stream (header included) at which the descriptor begins
    uint words;       // packed: words in the stream
    uvec2 stream;     // packed: address of the stream
};

// vertex_decode.comp: one dispatch decodes `blocks` blocks from `first_block` on. Its descriptor begins at the first
// vertex of these blocks.
struct VertexConstants {
    uint first_block;
    uint blocks;
    uint stride;  // words from one vertex to the next
    uint unused;
    uvec2 stream;  // address of the stream
};
// Workgroup size of vertex_decode.comp and seam_decode.comp. An invocation decodes a block, or gives a copy its
// position (LR_SEAM_PASS_POSITIONS).
#define LR_VERTEX_GROUP_SIZE 32u

// seam_decode.comp: one dispatch decodes `blocks` blocks from `first_block` on. In LR_SEAM_PASS_POSITIONS both count
// copies. The descriptors begin at the first vertex, corner or copy of the dispatch.
struct SeamConstants {
    uint first_block;
    uint blocks;
    uint vertices;  // of the surface
    uint slots;     // of the surface's stream
    uint copies;
    uint words;     // of the seam section
    uvec2 section;  // addresses from here on
    uvec2 homes;
    uvec2 copy_vertices;
    uvec2 positions;
};
#define LR_SEAM_PASS_VERTICES 0u   // decodes vertex blocks
#define LR_SEAM_PASS_TRIANGLES 1u  // decodes triangle blocks
#define LR_SEAM_PASS_POSITIONS 2u  // gives each copy the position of its vertex

// rotate.comp: the descriptor covers the dispatch's part of the index buffer.
struct RotateConstants {
    uint triangles;      // in this dispatch
    uint ordered;        // 0: vertices have their original numbers; 1: vertex_order maps to these
    uvec2 vertex_order;  // address
};

// Constants of one frame.
struct FrameConstants {
    mat4 view_from_world;
    mat4 clip_from_view;
    vec4 line_color;  // with opacity
};
// Lines over the surface are moved toward the eye by this fraction of their distance.
#define LR_LINE_LIFT 0.0012

// Constants of one draw command. All per-triangle buffers are bound at the draw's first slot.
struct DrawConstants {
    uint first_slot;  // of the draw; Source::plain: the original number of its first triangle
    uint ordered;     // 1: slot_triangle maps slots to original triangles; 0: slots are in the original order
    uint slots;       // of the draw
    uint unused;
    // Addresses, for shaders that decode the stream themselves (all paths but Path::compute):
    uvec2 stream;
    uvec2 vertices;
    uvec2 vertex_order;
    uvec2 vertex_stream;
    uvec2 copies;
    uvec2 copy_vertices;
    // Addresses for LR_VIEW_MATERIAL: LR_SHADING_WORDS words per vertex, and a MaterialHead.
    uvec2 shading;
    uvec2 materials;
    uvec4 stream_layout;  // lean: LrLeanLayout; packed: LrPackedLayout
    // A position x of the mesh is (x - unit.xyz) * unit.w in the unit sphere.
    vec4 unit;
};

// Specialization constants of the shaders that decode the stream themselves (0 and 1: see surface.frag).
#define LR_CONSTANT_PACKED 2         // the stream is packed, not lean
#define LR_CONSTANT_ROTATE 3         // rotates triangles to begin with their smallest original vertex
#define LR_CONSTANT_VERTEX_STREAM 4  // decodes positions from a vertex stream

#define LR_CONSTANT_SEAMS 5  // reads triangles from `copies`

#define LR_CONSTANT_FOURS 6  // slot_words.comp: decodes four slots at a time

// Floats per vertex: position (absent if shaders decode it from a vertex stream), normal, position along the rings.
#define LR_POSITION_FLOATS 3u
#define LR_VERTEX_FLOATS 7u
// Slots per input point of surface.geom.
#define LR_GEOMETRY_SLOTS 4u
// Triangles per workgroup of surface.mesh. Its limits on triangles and vertices (3 * 64) are within those of Vulkan.
#define LR_MESH_TRIANGLES 64u

#define LR_VIEW_SMOOTH 0u
#define LR_VIEW_FLAT 1u
#define LR_VIEW_CLASS 2u
#define LR_VIEW_RING 3u
#define LR_VIEW_WIRE 4u
#define LR_VIEW_OFFSETS 5u
#define LR_VIEW_SILHOUETTE 6u
#define LR_VIEW_SEAMS 7u
#define LR_VIEW_MATERIAL 8u

// Shading words per vertex: two sets of texture coordinates (4 floats) and a color (4 numbers of 16 bits).
#define LR_SHADING_WORDS 6u

// Start of the material buffer. A MaterialConstants for each material follows.
struct MaterialHead {
    uvec2 of_triangle;  // address of the material numbers, one per triangle of the mesh
    uvec2 texels;       // address of the texels of all images and mip maps, row by row, one byte per channel
};
// A texture of a material.
struct TextureConstants {
    uint first;     // first texel of the largest mip map; the others follow
    uint size;      // width and height, 16 bits each; 0: there is no texture
    uint levels;    // number of mip maps
    uint sampling;  // LR_TEXTURE_*
    // Rows of the transform from texture coordinates of the vertices to coordinates in the image.
    vec4 u, v;
};
#define LR_TEXTURE_SET 1u      // uses the second set of texture coordinates
#define LR_TEXTURE_NEAREST 2u  // nearest texel, no interpolation
#define LR_TEXTURE_WRAP_U 4u   // shift of 2 bits: 0 repeat, 1 mirror, 2 clamp
#define LR_TEXTURE_WRAP_V 6u
struct MaterialConstants {
    vec4 base_color;
    vec4 emissive;  // w: alpha cutoff
    vec4 surface;   // metallic, roughness, scale of the normal map, occlusion
    uvec4 flags;    // LR_MATERIAL_*
    TextureConstants base, metallic_roughness, normal, occluding, emitting;
};
#define LR_MATERIAL_DOUBLE_SIDED 1u
#define LR_MATERIAL_UNLIT 2u
#define LR_MATERIAL_MASK 4u
#define LR_MATERIAL_BLEND 8u
#define LR_MATERIAL_FLAT 16u

// In the image of triangle numbers, a pixel is 0 (background), or the original triangle + 1, with this flag if its
// front is seen.
#define LR_FRONT_FLAG 0x80000000u

// Triangle classes (paper: section 4.3, section 5), one byte per slot.
#define LR_CLASS_NONE 0u  // degenerate
#define LR_CLASS_T0 1u    // no ring edge
#define LR_CLASS_T1_LEFT 2u
#define LR_CLASS_T1_RIGHT 3u
#define LR_CLASS_T2 4u       // two ring edges, or three
#define LR_CLASS_T0_WART 5u  // a T0 that is stored in the redundant slot of a T2
#define LR_CLASS_T2_WART 6u  // a T2 whose redundant slot stores a T0

// LR_VIEW_OFFSETS: a slot's byte is the number of significant bits (1 to 31) of its offset along the ring, or:
#define LR_OFFSET_NONE 0u  // degenerate, or a tip on no ring
#define LR_OFFSET_T0 255u  // verbatim

#ifdef __cplusplus
}  // namespace lacedring::gpu
#endif
#endif
