// Host and kernels see every member of every shared struct at the same place, in arrays, in the uniform block and in
// push constants.

#include <cstring>
#include <type_traits>

#include <gtest/gtest.h>

#include "kernels/layout_members.h"
#include "kernels/probe.h"
#include "support/device/gpu.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t layout_words[] = {
#include "layout.spv.inc"
};

template <typename Visit> void scalars(float& x, Visit visit) { visit(x); }
template <typename Visit> void scalars(std::uint32_t& x, Visit visit) { visit(x); }
template <glm::length_t L, typename T, glm::qualifier Q, typename Visit>
void scalars(glm::vec<L, T, Q>& v, Visit visit) {
    for (glm::length_t c = 0; c < L; ++c) visit(v[c]);
}
template <typename T, std::size_t N, typename Visit> void scalars(T (&array)[N], Visit visit) {
    for (T& element : array) scalars(element, visit);
}

// One overload a struct: visits its scalars in order.
#define X(member) scalars(value.member, visit);
#define VISITOR(Struct, MEMBERS) \
    template <typename Visit> void each_scalar(gpu::Struct& value, Visit visit) { MEMBERS }
VISITOR(BvhNode, MEMBERS_BVH_NODE)
VISITOR(InstanceNode, MEMBERS_INSTANCE_NODE)
VISITOR(Instance, MEMBERS_INSTANCE)
VISITOR(TriangleGeometry, MEMBERS_TRIANGLE_GEOMETRY)
VISITOR(TriangleShading, MEMBERS_TRIANGLE_SHADING)
VISITOR(SurfaceMaterial, MEMBERS_SURFACE_MATERIAL)
VISITOR(TextureLookup, MEMBERS_TEXTURE_LOOKUP)
VISITOR(Light, MEMBERS_LIGHT)
VISITOR(AskedGroup, MEMBERS_ASKED_GROUP)
template <typename Visit> void scalars(gpu::AskedGroup& group, Visit visit) { each_scalar(group, visit); }
VISITOR(AskedLight, MEMBERS_ASKED_LIGHT)
VISITOR(LightBranch, MEMBERS_LIGHT_BRANCH)
VISITOR(LightRay, MEMBERS_LIGHT_RAY)
template <typename Visit> void scalars(gpu::LightRay& ray, Visit visit) { each_scalar(ray, visit); }
VISITOR(LightRays, MEMBERS_LIGHT_RAYS)
template <typename Visit> void scalars(gpu::LightRays& rays, Visit visit) { each_scalar(rays, visit); }
VISITOR(Photon, MEMBERS_PHOTON)
VISITOR(PhotonFlux, MEMBERS_PHOTON_FLUX)
VISITOR(HitPosition, MEMBERS_HIT_POSITION)
VISITOR(HitWeight, MEMBERS_HIT_WEIGHT)
VISITOR(HitEmission, MEMBERS_HIT_EMISSION)
VISITOR(HitSurface, MEMBERS_HIT_SURFACE)
VISITOR(Gathered, MEMBERS_GATHERED)
VISITOR(PixelState, MEMBERS_PIXEL_STATE)
VISITOR(Aovs, MEMBERS_AOVS)
VISITOR(Film, MEMBERS_FILM)
VISITOR(PathState, MEMBERS_PATH_STATE)
VISITOR(TraceState, MEMBERS_TRACE_STATE)
VISITOR(EyeState, MEMBERS_EYE_STATE)
VISITOR(SearchState, MEMBERS_SEARCH_STATE)
VISITOR(Cursor, MEMBERS_CURSOR)
VISITOR(Grid, MEMBERS_GRID)
VISITOR(Status, MEMBERS_STATUS)
VISITOR(Params, MEMBERS_PARAMS)
VISITOR(Launch, MEMBERS_LAUNCH)

/// A struct whose scalars all differ; `element` tells elements of an array apart. Small enough to be exact as floats.
template <typename S> S distinct(std::uint32_t element) {
    S value{};
    std::uint32_t next = 1000 * (element + 1);
    each_scalar(value, [&](auto& scalar) { scalar = std::remove_reference_t<decltype(scalar)>(next += 3); });
    return value;
}

/// What the probe makes of it: the n-th scalar grows by n.
template <typename S> S bumped(S value) {
    std::uint32_t ordinal = 0;
    each_scalar(value, [&](auto& scalar) { scalar += std::remove_reference_t<decltype(scalar)>(++ordinal); });
    return value;
}

/// The storage buffer that block `index` of layout.comp is bound to.
Binding block(std::uint32_t index) {
    const auto binding = Binding(std::uint32_t(Binding::hit_position) + index);
    if (binding == Binding::errors) return Binding::status;
    // Those two are read as texels alone.
    return binding == Binding::instances ? Binding::grid : binding == Binding::quantiles ? Binding::errors : binding;
}

class Layout : public GpuTest {
protected:
    template <typename S> void upload(Binding binding) {
        probe_.input(binding, std::vector<S>{distinct<S>(0), distinct<S>(1), S{}, S{}, S{}});
    }

    template <typename S> void expect_equal(const char* name, S got, S want) {
        std::vector<double> wanted;
        each_scalar(want, [&](auto& scalar) { wanted.push_back(double(scalar)); });
        std::size_t ordinal = 0;
        each_scalar(got, [&](auto& scalar) {
            EXPECT_EQ(double(scalar), wanted[ordinal]) << name << ", scalar " << ordinal << " of " << wanted.size();
            ++ordinal;
        });
    }

    template <typename S> void check(Binding binding, const char* name) {
        std::size_t listed = 0;
        S value{};
        each_scalar(value, [&](auto&) { ++listed; });
        ASSERT_EQ(4 * listed, sizeof(S)) << name << " has a member that layout_members.h does not list";
        const std::vector<S> values = probe_.result<S>(binding, 5);
        expect_equal(name, values[0], distinct<S>(0));
        expect_equal(name, values[1], distinct<S>(1));
        expect_equal(name, values[2], bumped(distinct<S>(0)));
        expect_equal(name, values[3], bumped(distinct<S>(1)));
    }

    Probe probe_{"layout", layout_words};
};

// clang-format off
#define FOR_STRUCTS(F)                                                                                                \
    F(0, BvhNode)                                                                                                     \
    F(1, TriangleGeometry) F(2, TriangleShading) F(3, SurfaceMaterial) F(4, Light) F(5, Photon) F(6, PhotonFlux)      \
        F(7, HitPosition) F(8, HitWeight) F(9, HitEmission) F(10, Gathered) F(11, PixelState) F(12, Aovs) F(13, Film) \
            F(14, PathState) F(15, Cursor) F(16, Grid) F(17, Status) F(18, Params) F(19, Launch)                      \
                F(20, TextureLookup) F(21, HitSurface) F(22, TraceState) F(23, LightRay) \
                    F(24, EyeState) F(25, SearchState) F(26, AskedLight) F(27, Instance) F(28, InstanceNode) \
                        F(29, LightBranch)
// clang-format on

TEST_F(Layout, EveryMemberStandsWhereTheHostPutsIt) {
#define UPLOAD(index, Struct) upload<gpu::Struct>(block(index));
    FOR_STRUCTS(UPLOAD)
    const auto params = distinct<gpu::Params>(7);
    probe_.input(Binding::params, std::vector{params});
    const auto launch = distinct<gpu::Launch>(8);
    probe_.run(1, launch);
#define CHECK(index, Struct) check<gpu::Struct>(block(index), #Struct);
    FOR_STRUCTS(CHECK)
    expect_equal("uniform Params", probe_.result<gpu::Params>(block(18), 5)[4], bumped(params));
    expect_equal("push constants", probe_.result<gpu::Launch>(block(19), 5)[4], bumped(launch));
}

}  // namespace
}  // namespace vkcppm::test
