#pragma once
// One mesh, its ring and its streams. Made by the loader; immutable.

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "app/cli/mesh_input.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/surface.hpp"
#include "lacedring/topology.hpp"
#include "renderer/mesh/source.h"

namespace lacedring::app {
struct FormatSet;  // app/formats/formats.h, which is slow to compile
}

namespace lacedring::view {

using Input = app::MeshInput;

/// Options for making the ring, as on the panel.
struct RingSettings {
    bool hybrid = false;
    std::uint32_t k = 100;    ///< RingOptions::k
    std::uint32_t seeds = 1;  ///< per component
    std::uint64_t random_seed = 1;
    CornerId start = kNullCorner;  ///< seed corner; null: in the first triangle
    std::uint32_t passes = 24;     ///< of the optimizer
    bool warts = true;             ///< wart skipping

    bool operator==(const RingSettings&) const = default;
};

/// Figures of one stream, per triangle of the input.
struct StreamFigures {
    std::size_t bytes = 0;
    double references = 0;  ///< per triangle; 0: the stream has none
    double bits = 0;        ///< per triangle
    double acmr = 0;        ///< with a FIFO cache of 32
};

/// A model that owns the mesh and the materials it points to.
struct OwningModel : gpu::Model {
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const Materials> owned_materials;
    /// The file has materials. It is then first shown in View::material, unless the user has chosen a view.
    bool has_materials = false;
};

struct Document {
    std::string path;
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const Surface> surface;
    std::shared_ptr<const CornerTable> table;  ///< of the surface
    std::shared_ptr<const Rings> rings;        ///< of lean
    /// How expand_rings made the rings, before the optimizer.
    std::shared_ptr<const Expansion> expansion;
    std::shared_ptr<const OwningModel> model;
    /// Views of the model's streams; packed is empty until it is made.
    gpu::StreamViews views;
    RingSettings settings;
    /// The optimizer has run settings.passes passes.
    bool optimized = false;
    /// If this is a coarse stand-in: the triangles of the mesh that is being loaded; else 0.
    std::size_t stand_in = 0;
    TopologyReport report;  ///< set if `optimized`
    StreamFigures plain, lean, packed;
    std::chrono::steady_clock::time_point asked;  ///< when the file or the ring was requested
    double seconds = 0;                           ///< from the request until this was made

    /// The vertex of the mesh at a corner of the table: one of the copies of the corner's surface vertex.
    std::uint32_t copy_at(CornerId c) const {
        const std::uint32_t t = c.value / 3, place = c.value % 3;
        return mesh->indices[3 * std::size_t{t} + (place > 0 && table->flipped(TriangleId{t}) ? 3 - place : place)];
    }
    double bits_per_triangle(std::size_t bytes) const {
        const std::size_t triangles = mesh->triangle_count() - table->topology.degenerate;
        return 8.0 * static_cast<double>(bytes) / static_cast<double>(std::max<std::size_t>(1, triangles));
    }
    double t0_share() const {
        return static_cast<double>(model->lean.statistics.t0) / static_cast<double>(mesh->triangle_count());
    }
};

/// LR tables of a mesh's surface. They take longer to make and arrive after the document.
struct Tables {
    std::shared_ptr<const Mesh> mesh;
    EncodedLr lr;
    LrView view;          ///< of lr.words
    double crease = 180;  ///< crease_angle
    /// number[mesh triangle] = LR triangle; UINT32_MAX: degenerate.
    std::vector<std::uint32_t> number;
    /// triangle[LR triangle] = mesh triangle; UINT32_MAX: none.
    std::vector<std::uint32_t> triangle;
};
/// Errors: malformed (the tables are not valid).
Result<Tables> make_tables(std::shared_ptr<const Mesh> mesh, EncodedLr lr);

/// Angle in degrees between triangles from which an edge is drawn as a crease: the smallest of 40, 55, 70 and 90 at
/// which most of the sharper edges form longer lines, unlike the single folds of a scan; 180 if there is none.
double crease_angle(const Document& document);

/// Applies the operator n, p, o, s, l or r with the LR tables. Takes and returns corners of the corner table; null at a
/// border.
CornerId lr_step(const Tables& tables, const CornerTable& table, CornerId corner, char operation);

/// The entries of the tables for a corner's triangle, as one line of text.
std::string lr_text(const Tables& tables, const CornerTable& table, CornerId corner);

}  // namespace lacedring::view
