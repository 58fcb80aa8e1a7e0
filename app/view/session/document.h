#pragma once
// One mesh and what was made of it. Made by the loader, never changed after.

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

/// How the ring is made, as the panel has it.
struct RingSettings {
    bool hybrid = false;
    std::uint32_t k = 100;    ///< of the hybrid
    std::uint32_t seeds = 1;  ///< per component
    std::uint64_t random_seed = 1;
    CornerId start = kNullCorner;  ///< where it begins; null: at the first triangle
    std::uint32_t passes = 24;     ///< of the optimiser
    bool warts = true;             ///< wart skipping

    bool operator==(const RingSettings&) const = default;
};

/// RingSettings::hybrid

/// Figures of one stream. Per triangle of the input, as everywhere.
struct StreamFigures {
    std::size_t bytes = 0;
    double references = 0;  ///< a triangle; 0 where it has none
    double bits = 0;        ///< a triangle
    double acmr = 0;        ///< FIFO of 32
};

/// A model that keeps what it points to.
struct OwningModel : gpu::Model {
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const Materials> owned_materials;
    bool has_materials = false;  ///< of the file: it is drawn with them at first
};

struct Document {
    std::string path;
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const Surface> surface;
    std::shared_ptr<const CornerTable> table;    ///< the surface's
    std::shared_ptr<const Rings> rings;          ///< lean's
    std::shared_ptr<const Expansion> expansion;  ///< how these were begun, before the optimiser
    std::shared_ptr<const OwningModel> model;
    gpu::StreamViews views;  ///< of the model's streams; packed is empty until it is made
    RingSettings settings;
    bool optimised = false;    ///< the optimiser has run, as often as the settings say
    std::size_t stand_in = 0;  ///< triangles of the mesh that this is a coarse one of, until that is ready; else 0
    TopologyReport report;     ///< once the optimiser has run
    StreamFigures plain, lean, packed;
    std::chrono::steady_clock::time_point asked;  ///< when a file or a ring was
    double seconds = 0;                           ///< from then until this was made

    /// The mesh's vertex at a corner of the table: the copy of its surface vertex.
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

/// What takes longer, and comes later.
struct Tables {
    std::shared_ptr<const Mesh> mesh;  ///< of whose surface they are
    EncodedLr lr;
    LrView view;                          ///< of its words
    double crease = 180;                  ///< degrees from which on an edge is one (crease_angle)
    std::vector<std::uint32_t> number;    ///< LR triangle of each of the mesh's, UINT32_MAX: degenerate
    std::vector<std::uint32_t> triangle;  ///< the mesh's triangle of each LR number, UINT32_MAX: none
};
/// Errors: malformed (the tables are not valid).
Result<Tables> make_tables(std::shared_ptr<const Mesh> mesh, EncodedLr lr);

/// The smallest of some angles from 40 degrees on at which most of the edges that are sharper continue each other:
/// lines that a person sees, not single folds of a scan. 180: none.
double crease_angle(const Document& document);

/// Where the operator n p o s l r leads by the LR tables, from and to corners of the corner table; null where there is
/// nothing.
CornerId lr_step(const Tables& tables, const CornerTable& table, CornerId corner, char operation);

/// What the tables hold for a corner's triangle, in one line.
std::string lr_text(const Tables& tables, const CornerTable& table, CornerId corner);

}  // namespace lacedring::view
