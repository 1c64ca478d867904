// The settings of a render, one row each. Everything else follows from the rows: the members of Settings
// (render/settings_members.h) and their ranges (render/settings.h), the options of the command line and their help
// (app/options.cpp), what pictures, statistics and checkpoints say of a render (app/provenance.h,
// app/checkpoint_file.h), the parameters of a race's entrants.
//
// Included where SETTING is defined:
//   SETTING(member, type, default, name, kind, values, unit, help)
//     name    of the option, without its dashes; '-' is '_' in files
//     kind    what it decides, from which follows who takes it: setting::Kind
//     values  that it takes: of render/settings_rows.h; what depends on several settings is in resolve_settings
//     unit    of its value, from which follows how it is written: setting::Unit
//     help    where {} is the default, {choices} the values of a list with what they are
// The order is that of --help, of what is told of a render and of the checks.
// clang-format off

SETTING(estimator, std::string, "cppm", "estimator", method, an_estimator(), name,
        "How photons become radiance:{choices}\n(default: {})")

// An upper bound where there is a time.
SETTING(iterations, std::uint32_t, 64, "iterations", bound, within(1u, max_iterations), count,
        "Iterations (default: {}; unbounded with --time)")

// Wall time, after which the running iteration is the last.
SETTING(seconds, std::optional<double>, std::nullopt, "time", bound, between(0.0, 1e9), seconds,
        "Stop after the iteration in which this time has passed: 90, 90s, 2m, 1.5h, 500ms")

// Absent: counted for the scene and the size of the picture (render/light_paths.h); resolved by what renders.
SETTING(photons, std::optional<std::uint32_t>, std::nullopt, "photons", paths, within(1u, 1u << 24), count,
        "Light paths emitted an iteration (default: as many as suit scene and size;\n"
        "65536 with --direct gathered and of a reference)")

// Absent: 512 on the longer side.
SETTING(size, std::optional<Extent>, std::nullopt, "size", picture, pixels(65536u, std::size_t(1) << 31), pixels,
        "Pixels (default: 512 on the longer side, in the camera's aspect)")

// Empty: the first; resolved: an index.
SETTING(camera, std::string, "", "camera", view, any(), camera,
        "Camera by its name, its node's or its index (default: the first)")

// 0 is a pinhole.
SETTING(aperture, double, 0.0, "aperture", view, within(0.0, longest), metres,
        "Diameter of the lens; what is not at --focus-distance is blurred (default: {}, all is sharp)")

// Instead of an aperture.
SETTING(fstop, std::optional<double>, std::nullopt, "fstop", view, within(0.01, 1e6), number,
        "The lens by its f-number, of a camera whose film is 36 mm on its longer side")

SETTING(focus_distance, std::optional<double>, std::nullopt, "focus-distance", view, within(1.0 / longest, longest),
        metres, "From the camera along its axis to what is sharp; goes with --aperture")

SETTING(seed, std::uint32_t, 1, "seed", picture, any(), count,
        "Same seed, same picture (default: {})")

// Of a light path and of an eye path.
SETTING(max_depth, std::uint32_t, 64, "max-depth", paths, within(1u, 1024u), count,
        "Bounces of a path (default: {})")

SETTING(direct, std::string, direct_sampled, "direct", parameter,
        words(Word{direct_sampled, "eye paths ask for it at every surface (next-event estimation)"},
              Word{direct_gathered, "photons bring it as all other light"}),
        name, "Light that comes straight from its source:{choices}\n(default: {})")

SETTING(disc_area, std::string, area_measured, "disc-area", parameter,
        words(Word{area_measured, "that of the surface in it, as rays find it: edges are not dark"},
              Word{area_whole, "pi R^2, as in the paper"}),
        name, "By which area the photons of a disc are divided:{choices}\n(default: {})")

SETTING(knn, std::uint32_t, 10, "knn", parameter, within(2u, 256u), count,
        "The starting radius reaches this many photons (default: {})")

SETTING(alpha, double, 2.0 / 3.0, "alpha", parameter, between(0.0, 1.0), number,
        "sppm, sppm-kz: how slowly the radius shrinks (default: {:.3g})")

SETTING(k, double, 0.8, "k", parameter, between(0.0, 1.0), number,
        "cppm, ftest: factor of the area after a rejection (default: {})")

SETTING(beta, double, 1.2, "beta", parameter, within(1.0, 1000.0), number,
        "cppm, ftest: growth of the batch after a rejection (default: {})")

SETTING(significance, double, 0.05, "significance", parameter, between(0.0, 1.0), number,
        "cppm, ftest: level of each test (default: {})")

SETTING(rings, std::uint32_t, 2, "rings", parameter, within(1u, std::uint32_t(MAX_RINGS)), count,
        "cppm, ftest: rings of the disc (default: {})")

SETTING(sectors, std::uint32_t, 6, "sectors", parameter, one_of(4u, 6u, 8u, 12u), count,
        "cppm, ftest: sectors of the disc: 4, 6, 8 or 12 (default: {})")

SETTING(aovs, bool, false, "aovs", layers, any(), flag,
        "Add channels to the EXR: ppm.radius, ppm.photons, ppm.batch, ppm.rejections, ppm.statistic,\n"
        "ppm.iterations; Z, Albedo, N of the first surfaces; A, the share of eye paths that met one; and\n"
        "direct, caustic and rest, the layers of the picture")

SETTING(error, bool, false, "error", channels, any(), flag,
        "Estimate the error without a reference, noise and bias apart: of the picture, and of every pixel\n"
        "in the channels StdErr, Bias and Bound of the EXR")

// The half of a reference that is caustics alone (study/reference.h): the starting radius in footprints of the pixel, a
// quarter of it at a photon's first rough surface.
SETTING(caustics, std::optional<double>, std::nullopt, "caustics", internal, any(), number, "")

// clang-format on
