#include "flat/solids.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <boost/geometry/strategies/strategies.hpp>  // the tree needs it, and Boost 1.83 does not bring it along
#include <boost/geometry/algorithms/intersects.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "scene/diagnosis/glass.h"
#include "scene/diagnosis/shell.h"
#include "scene/instances.h"

namespace vkcppm {
namespace {

namespace geometry = boost::geometry;
using Point3 = geometry::model::point<double, 3, geometry::cs::cartesian>;
using Box3 = geometry::model::box<Point3>;
using Entry3 = std::pair<Box3, std::uint32_t>;  // of a triangle of the scene, or of a body
using Tree = geometry::index::rtree<Entry3, geometry::index::quadratic<16>>;
using Triangle3 = std::array<glm::dvec3, 3>;

constexpr std::size_t most_solid_angles = std::size_t(1) << 26;  // seconds

Box3 box_of(const glm::dvec3& low, const glm::dvec3& high) { return {{low.x, low.y, low.z}, {high.x, high.y, high.z}}; }

Box3 box_of(const Triangle3& p) {
    return box_of(glm::min(p[0], glm::min(p[1], p[2])), glm::max(p[0], glm::max(p[1], p[2])));
}

/// Six times the signed volume of the tetrahedron.
double volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    return glm::dot(b - a, glm::cross(c - a, d - a));
}

/// True where an edge of `a` goes through `b`, also by its rim: of bodies that are flush with one another sideways
/// nothing else meets.
bool pierces(const Triangle3& a, const Triangle3& b) {
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 &p = a[i], &q = a[(i + 1) % 3];
        if (volume(p, b[0], b[1], b[2]) * volume(q, b[0], b[1], b[2]) >= 0.0) continue;
        const double u = volume(p, q, b[0], b[1]), v = volume(p, q, b[1], b[2]), w = volume(p, q, b[2], b[0]);
        constexpr double rounding = 1e-5;  // of barycentrics
        if (std::min({u, v, w}) >= -rounding * std::abs(u + v + w)) return true;
        if (std::max({u, v, w}) <= rounding * std::abs(u + v + w)) return true;
    }
    return false;
}

/// The shells of solid glass in one space: in the world, or of one shared mesh.
class Space {
public:
    Space(const Scene& scene, std::span<const Shell> shells) : scene_(scene), shells_(shells) {}

    /// Two shells that overlap or of which one is in the other; none where there are none.
    std::optional<std::pair<const Shell*, const Shell*>> nested() {
        std::vector<Entry3> boxes;
        for (std::uint32_t i = 0; i < shells_.size(); ++i)
            boxes.emplace_back(box_of(shells_[i].low, shells_[i].high), i);
        const Tree tree(boxes);
        for (std::uint32_t i = 0; i < shells_.size(); ++i) {
            const Shell& shell = shells_[i];
            std::vector<const Shell*> near;
            for (auto entry = tree.qbegin(geometry::index::intersects(boxes[i].first)); entry != tree.qend(); ++entry) {
                if (entry->second != i) near.push_back(&shells_[entry->second]);
            }
            if (near.empty()) continue;
            if (const Shell* other = crossed_by(shell, near)) return std::pair(&shell, other);
            // What turns round what it leaves out is a cavity of another.
            if (shell.volume <= 0.0) continue;
            if (const Shell* other = holder_of(shell, near)) return std::pair(&shell, other);
        }
        return std::nullopt;
    }

private:
    /// One that this shell crosses, of those that have no more triangles: each pair is looked at from the larger.
    const Shell* crossed_by(const Shell& shell, std::vector<const Shell*> near) const {
        const auto size = [](const Shell* s) { return std::pair(s->triangles.size(), s->triangles.front()); };
        std::erase_if(near, [&](const Shell* other) { return size(other) > size(&shell); });
        if (near.empty()) return nullptr;
        std::vector<Entry3> faces;
        for (const std::uint32_t i : shell.triangles) faces.emplace_back(box_of(corners_of(scene_, i)), i);
        const Tree tree(faces);
        const Box3 whole = tree.bounds();
        for (const Shell* other : near) {
            for (const std::uint32_t k : other->triangles) {
                const Triangle3 b = corners_of(scene_, k);
                const Box3 box = box_of(b);
                if (!geometry::intersects(box, whole)) continue;
                for (auto entry = tree.qbegin(geometry::index::intersects(box)); entry != tree.qend(); ++entry) {
                    const Triangle3 a = corners_of(scene_, entry->second);
                    if (pierces(a, b) || pierces(b, a)) return other;
                }
            }
        }
        return nullptr;
    }

    /// A shell in whose glass this one lies. They do not cross, so that any of its points tells.
    const Shell* holder_of(const Shell& shell, const std::vector<const Shell*>& near) {
        const glm::dvec3 point(corners_of(scene_, shell.triangles.front())[0]);
        const Shell* holder = nullptr;
        double turns = 0.0;
        for (const Shell* other : near) {
            if (!other->is_closed() || glm::any(glm::lessThan(point, other->low)) ||
                glm::any(glm::greaterThan(point, other->high))) {
                continue;
            }
            work_ += other->triangles.size();
            if (work_ > most_solid_angles) return other;
            const double winding = winding_number(scene_, *other, point);
            if (winding > inside_turns) holder = other;
            turns += winding;
        }
        return turns > inside_turns ? holder : nullptr;
    }

    const Scene& scene_;
    std::span<const Shell> shells_;
    std::size_t work_ = 0;
};

std::uint32_t material_of(const Scene& scene, const Shell& shell) {
    return scene.triangles[shell.triangles.front()].material;
}

/// The first instance of a solid whose box meets that of another solid; none: nothing does.
std::optional<std::pair<std::uint32_t, std::uint32_t>> nested_instances(const Scene& scene,
                                                                        std::span<const Shell> shells) {
    std::vector<std::uint32_t> solid(scene.meshes.size(), std::uint32_t(scene.materials.size()));
    bool is_shared = false;      // some solid
    std::vector<Entry3> bodies;  // by material
    for (const Shell& shell : shells) {
        if (const auto mesh = mesh_of(scene, shell.triangles.front())) {
            solid[*mesh] = material_of(scene, shell);
            is_shared = true;
        } else {
            bodies.emplace_back(box_of(shell.low, shell.high), material_of(scene, shell));
        }
    }
    if (!is_shared) return std::nullopt;
    const std::size_t first = bodies.size();
    const std::vector<SceneBox> boxes = instance_boxes(scene);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const std::uint32_t material = solid[scene.instances[i].mesh];
        if (material < scene.materials.size()) bodies.emplace_back(box_of(boxes[i].low, boxes[i].high), material);
    }
    const Tree tree(bodies);
    for (std::size_t i = first; i < bodies.size(); ++i) {
        std::size_t met = 0;
        for (auto entry = tree.qbegin(geometry::index::intersects(bodies[i].first)); entry != tree.qend(); ++entry) {
            if (++met > 1) return std::pair(bodies[i].second, entry->second);  // itself is one
        }
    }
    return std::nullopt;
}

}  // namespace

std::vector<Shell> solid_shells(const Scene& scene, const std::vector<MaterialTraits>& traits) {
    std::vector<std::vector<std::uint32_t>> triangles(scene.materials.size());
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const std::uint32_t material = scene.triangles[i].material;
        if (is_solid(traits[material])) triangles[material].push_back(i);
    }
    std::vector<Shell> shells;
    std::vector<std::uint32_t> open;
    const auto add = [&](std::vector<Shell> found) { std::ranges::move(found, std::back_inserter(shells)); };
    for (const std::vector<std::uint32_t>& of_material : triangles) {
        std::vector<Shell> found = find_shells(scene, of_material);
        if (std::ranges::all_of(found, [](const Shell& shell) { return shell.open_edges == 0; })) {
            add(std::move(found));
        } else {
            open.insert(open.end(), of_material.begin(), of_material.end());
        }
    }
    std::ranges::sort(open);
    add(find_shells(scene, open));
    std::ranges::sort(shells, {}, [](const Shell& shell) { return shell.triangles.front(); });
    return shells;
}

std::string nested_solids(const Scene& scene, std::span<const Shell> shells) {
    const auto named = [&](std::uint32_t a, std::uint32_t b) {
        return fmt::format("material '{}' with '{}'", scene.materials[a].name, scene.materials[b].name);
    };
    if (const auto pair = nested_instances(scene, shells)) return named(pair->first, pair->second);
    for (const std::span<const Shell> space : by_space(scene, shells)) {
        if (const auto pair = Space(scene, space).nested()) {
            return named(material_of(scene, *pair->first), material_of(scene, *pair->second));
        }
    }
    return {};
}

std::vector<std::uint32_t> priorities_of(const Scene& scene, const std::vector<MaterialTraits>& traits,
                                         std::span<const Shell> shells) {
    std::vector<double> scales(scene.meshes.size()), shown(scene.meshes.size());
    for (const Instance& instance : scene.instances) {
        scales[instance.mesh] += std::abs(glm::determinant(glm::dmat3(instance.to_world)));
        ++shown[instance.mesh];
    }
    struct Bodies {
        double volume = 0.0;  // m^3, cavities taken off
        double count = 0.0;
    };
    // Of each material the least one with which it has bodies in common, by some way.
    std::vector<std::uint32_t> least(scene.materials.size());
    std::iota(least.begin(), least.end(), 0u);
    for (bool changed = true; changed;) {
        changed = false;
        for (const Shell& shell : shells) {
            const auto of = [&](std::uint32_t triangle) -> std::uint32_t& {
                return least[scene.triangles[triangle].material];
            };
            const std::uint32_t common = of(*std::ranges::min_element(shell.triangles, {}, of));
            for (const std::uint32_t i : shell.triangles) {
                changed = changed || of(i) != common;
                of(i) = common;
            }
        }
    }
    std::vector<Bodies> bodies(scene.materials.size());  // by those
    for (const Shell& shell : shells) {
        if (!shell.is_closed()) continue;
        const auto mesh = mesh_of(scene, shell.triangles.front());
        Bodies& of_material = bodies[least[material_of(scene, shell)]];
        of_material.volume += shell.volume * (mesh ? scales[*mesh] : 1.0);
        if (shell.volume > 0.0) of_material.count += mesh ? shown[*mesh] : 1.0;
    }
    std::vector<std::uint32_t> solids;
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
        if (is_solid(traits[i]) && least[i] == i) solids.push_back(i);
    }
    const auto size = [&](std::uint32_t i) {
        return bodies[i].count > 0.0 ? bodies[i].volume / bodies[i].count : std::numeric_limits<double>::infinity();
    };
    std::ranges::stable_sort(solids, std::ranges::greater(), size);
    std::vector<std::uint32_t> priorities(scene.materials.size(), 0);
    for (std::uint32_t rank = 0; rank < solids.size(); ++rank) priorities[solids[rank]] = rank + 1;
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) priorities[i] = priorities[least[i]];
    return priorities;
}

Media media_at(const std::vector<SolidFace>& faces, const glm::vec3& point) {
    // How often each winds around the point; that which counts first.
    std::map<std::pair<std::uint32_t, std::uint32_t>, double, std::greater<>> turns;
    for (const SolidFace& face : faces) {
        const Triangle3 corners{glm::dvec3(face.corners[0]), glm::dvec3(face.corners[1]), glm::dvec3(face.corners[2])};
        turns[{face.priority, face.material}] += share_of_directions(corners, glm::dvec3(point));
    }
    std::vector<std::uint32_t> media;
    for (const auto& [solid, winding] : turns) {
        for (int i = 0; i < int(std::lround(std::min(winding, 5.0))); ++i) media.push_back(solid.second);
    }
    media.resize(5, PATH_NO_MEDIUM);
    return {media[0], {media[1] | media[2] << 16, media[3] | media[4] << 16}};
}

}  // namespace vkcppm
