// The extensions of a glTF material: a row each, and in it a row a member. From them follow the members of Material
// (scene/scene.h), what a file may hold (scene/gltf/schema.cpp), what is read of it (scene/gltf/materials.cpp) and the
// textures of a surface (flat/material.cpp). Whoever includes this defines of the following what it asks for:
//   EXTENSION(name, rows...)
//   FACTOR(member, "json", standard, low, high)  a number, which is clamped with a warning
//   COLOR(member, "json", standard, high)        three channels of 0 to high, likewise
//   TEXTURE(NUMBER, member, "json", "words", encoding, where)
//                                                a TextureUse of TEXTURE_<NUMBER>; encoding: srgb or linear; words: its
//                                                name for people; read of a Material m for which `where` is true
//   NORMALS(NUMBER, member, "json", "words", scale, where)
//                                                a normal texture, and the member for its scale
//   OTHER(kind, "json")                          checked as what the schema calls `kind`; the rest is by hand
// standard: glTF's, where the file says nothing. Members that are clamped or read by rules of their own, and extensions
// that say all by being there, stand in scene/scene.h and scene/gltf/materials.cpp.
// clang-format off
#ifndef FACTOR
#define FACTOR(member, json, standard, low, high)
#endif
#ifndef COLOR
#define COLOR(member, json, standard, high)
#endif
#ifndef TEXTURE
#define TEXTURE(NUMBER, member, json, words, encoding, where)
#endif
#ifndef NORMALS
#define NORMALS(NUMBER, member, json, words, scale, where)
#endif
#ifndef OTHER
#define OTHER(kind, json)
#endif

EXTENSION(KHR_materials_emissive_strength,
    OTHER(number, "emissiveStrength"))
EXTENSION(KHR_materials_transmission,
    FACTOR(transmission, "transmissionFactor", 0.0f, 0.0, 1.0)
    TEXTURE(TRANSMISSION, transmission_texture, "transmissionTexture", "transmission", linear,  // r
            m.transmission > 0.0f))
EXTENSION(KHR_materials_volume,
    FACTOR(thickness, "thicknessFactor", 0.0f, 0.0, FLT_MAX)  // above 0: a solid volume, as thick as its mesh
    COLOR(attenuation_color, "attenuationColor", 1.0f, 1.0)
    OTHER(number, "attenuationDistance")
    OTHER(texture, "thicknessTexture"))
EXTENSION(KHR_materials_ior,
    OTHER(number, "ior"))
EXTENSION(KHR_materials_dispersion,
    FACTOR(dispersion, "dispersion", 0.0f, 0.0, FLT_MAX))  // 20 / Abbe number
EXTENSION(KHR_materials_specular,
    FACTOR(specular, "specularFactor", 1.0f, 0.0, 1.0)
    COLOR(specular_color, "specularColorFactor", 1.0f, FLT_MAX)
    TEXTURE(SPECULAR, specular_texture, "specularTexture", "specular", linear,  // a
            m.specular > 0.0f)
    TEXTURE(SPECULAR_COLOR, specular_color_texture, "specularColorTexture", "specular colour", srgb,
            m.specular > 0.0f && m.specular_color != glm::vec3(0.0f)))
EXTENSION(KHR_materials_clearcoat,
    FACTOR(clearcoat, "clearcoatFactor", 0.0f, 0.0, 1.0)
    FACTOR(clearcoat_roughness, "clearcoatRoughnessFactor", 0.0f, 0.0, 1.0)
    TEXTURE(CLEARCOAT, clearcoat_texture, "clearcoatTexture", "clearcoat", linear,  // r
            m.clearcoat > 0.0f)
    NORMALS(CLEARCOAT_NORMAL, clearcoat_normal_texture, "clearcoatNormalTexture", "clearcoat normal",
            clearcoat_normal_scale, m.clearcoat > 0.0f)
    TEXTURE(CLEARCOAT_ROUGHNESS, clearcoat_roughness_texture, "clearcoatRoughnessTexture", "clearcoat roughness",
            linear, m.clearcoat > 0.0f && m.clearcoat_roughness > 0.0f))  // g
EXTENSION(KHR_materials_anisotropy,
    FACTOR(anisotropy, "anisotropyStrength", 0.0f, 0.0, 1.0)
    FACTOR(anisotropy_rotation, "anisotropyRotation", 0.0f, -FLT_MAX, FLT_MAX)  // from tangent to bitangent, rad
    TEXTURE(ANISOTROPY, anisotropy_texture, "anisotropyTexture", "anisotropy", linear,  // rg: direction; b: strength
            m.anisotropy > 0.0f))
EXTENSION(KHR_materials_iridescence,
    FACTOR(iridescence, "iridescenceFactor", 0.0f, 0.0, 1.0)
    FACTOR(iridescence_ior, "iridescenceIor", 1.3f, 1.0, 100.0)
    FACTOR(iridescence_thickness_minimum, "iridescenceThicknessMinimum", 100.0f, 0.0, FLT_MAX)  // nm
    FACTOR(iridescence_thickness_maximum, "iridescenceThicknessMaximum", 400.0f, 0.0, FLT_MAX)
    TEXTURE(IRIDESCENCE, iridescence_texture, "iridescenceTexture", "iridescence", linear,  // r
            m.iridescence > 0.0f)
    TEXTURE(IRIDESCENCE_THICKNESS, iridescence_thickness_texture, "iridescenceThicknessTexture",
            "iridescence thickness", linear,  // g
            m.iridescence > 0.0f))
EXTENSION(KHR_materials_sheen,
    COLOR(sheen_color, "sheenColorFactor", 0.0f, 1.0)
    FACTOR(sheen_roughness, "sheenRoughnessFactor", 0.0f, 0.0, 1.0)
    TEXTURE(SHEEN_COLOR, sheen_color_texture, "sheenColorTexture", "sheen colour", srgb,
            m.sheen_color != glm::vec3(0.0f))
    TEXTURE(SHEEN_ROUGHNESS, sheen_roughness_texture, "sheenRoughnessTexture", "sheen roughness", linear,  // a
            m.sheen_color != glm::vec3(0.0f) && m.sheen_roughness > 0.0f))
EXTENSION(KHR_materials_unlit)
EXTENSION(KHR_materials_pbrSpecularGlossiness,  // rewritten as what took its place: scene/gltf/specular_glossiness.h
    OTHER(color_with_alpha, "diffuseFactor")
    OTHER(texture, "diffuseTexture")
    OTHER(color, "specularFactor")
    OTHER(number, "glossinessFactor")
    OTHER(texture, "specularGlossinessTexture"))
// clang-format on

#undef EXTENSION
#undef FACTOR
#undef COLOR
#undef TEXTURE
#undef NORMALS
#undef OTHER
