// How a kernel declares the buffers it uses: PHOTONS(STORES) and the like, after shared/buffers.h, which has the rows.
//   READS, STORES, UPDATES   name[] as a storage buffer that is read, written, or both
//   VALUE, UNIFORM           name, the one Element of a storage buffer or uniform block
//   TEXELS, FLOAT_TEXELS     name_texels, to be fetched by hand
//   RECORDS, WORD_RECORDS    name_at(index): the Element, a struct, decoded from texels by its FIELDS
//                            (shared/types.h), in texels of four words or of one
// What the access of a row does not have is an undeclared STORAGE_OF_<access> or TEXELS_OF_<access>.
#ifndef RECORDS_GLSL
#define RECORDS_GLSL

#define STORAGE_OF_storage 0
#define STORAGE_OF_records 0
#define STORAGE_OF_words 0
#define TEXELS_OF_records TEXELS_BINDING
#define TEXELS_OF_words TEXELS_BINDING
#define TEXELS_OF_uint_texels TEXELS_BINDING
#define TEXELS_OF_float_texels TEXELS_BINDING
#define TEXELS_OF_word_texels TEXELS_BINDING

#define STORAGE_BLOCK(qualifier, number, name, Element, access) \
    layout(binding = STORAGE_OF_##access + number, scalar) qualifier buffer name##_block { Element name[]; };
#define READS(number, name, Element, per, entries, access, life, hashed) \
    STORAGE_BLOCK(readonly, number, name, Element, access)
#define STORES(number, name, Element, per, entries, access, life, hashed) \
    STORAGE_BLOCK(writeonly, number, name, Element, access)
#define UPDATES(number, name, Element, per, entries, access, life, hashed) \
    STORAGE_BLOCK(, number, name, Element, access)
#define VALUE(number, name, Element, per, entries, access, life, hashed) \
    layout(binding = STORAGE_OF_##access + number, scalar) buffer name##_block { Element name; };
#define UNIFORM(number, name, Element, per, entries, access, life, hashed) \
    layout(binding = number, scalar) uniform name##_block { Element name; };

#define TEXELS(number, name, Element, per, entries, access, life, hashed) \
    layout(binding = TEXELS_OF_##access + number) uniform usamplerBuffer name##_texels;
#define FLOAT_TEXELS(number, name, Element, per, entries, access, life, hashed) \
    layout(binding = TEXELS_OF_##access + number) uniform samplerBuffer name##_texels;

// ---- decoding ----

#define WORDS_float 1
#define WORDS_uint 1
#define WORDS_vec2 2
#define WORDS_uvec2 2
#define WORDS_vec3 3
#define WORDS_uvec3 3
#define WORDS_vec4 4
#define WORDS_uvec4 4

#define COUNT_FIELD(type, name) + WORDS_##type
#define COUNT_ARRAY(features, type, name, count) + WORDS_##type * count
#define COUNT_OPTIONAL(features, absent, type, name) + WORDS_##type
#define WORDS_OF(Element) (0 FIELDS_##Element(COUNT_FIELD, COUNT_ARRAY, COUNT_OPTIONAL))

// Component k of a texel, k constant once functions are inlined.
uint component(uvec4 texel, int k) { return k == 0 ? texel.x : k == 1 ? texel.y : k == 2 ? texel.z : texel.w; }

// Words from number k on of a record that starts at texel `first`. FOUR: a texel holds four of them; ONE: one.
uint word_FOUR(usamplerBuffer texels, int first, int k) {
    return texelFetch(texels, first + (k >> 2))[k & 3];
}
uint word_ONE(usamplerBuffer texels, int first, int k) { return texelFetch(texels, first + k).x; }

#define DECODERS(SIZE)                                                                                               \
    uint uint_##SIZE(usamplerBuffer t, int first, int k) { return word_##SIZE(t, first, k); }                        \
    uvec2 uvec2_##SIZE(usamplerBuffer t, int first, int k) {                                                         \
        return uvec2(word_##SIZE(t, first, k), word_##SIZE(t, first, k + 1));                                        \
    }                                                                                                                \
    uvec3 uvec3_##SIZE(usamplerBuffer t, int first, int k) {                                                         \
        return uvec3(word_##SIZE(t, first, k), word_##SIZE(t, first, k + 1), word_##SIZE(t, first, k + 2));          \
    }                                                                                                                \
    uvec4 uvec4_##SIZE(usamplerBuffer t, int first, int k) {                                                         \
        return uvec4(uvec2_##SIZE(t, first, k), uvec2_##SIZE(t, first, k + 2));                                      \
    }                                                                                                                \
    float float_##SIZE(usamplerBuffer t, int first, int k) { return uintBitsToFloat(word_##SIZE(t, first, k)); }     \
    vec2 vec2_##SIZE(usamplerBuffer t, int first, int k) { return uintBitsToFloat(uvec2_##SIZE(t, first, k)); }      \
    vec3 vec3_##SIZE(usamplerBuffer t, int first, int k) { return uintBitsToFloat(uvec3_##SIZE(t, first, k)); }      \
    vec4 vec4_##SIZE(usamplerBuffer t, int first, int k) { return uintBitsToFloat(uvec4_##SIZE(t, first, k)); }
DECODERS(FOUR)
DECODERS(ONE)

#define DECODE_FIELD_FOUR(type, name)          \
    record.name = type##_FOUR(texels, first, k); \
    k += WORDS_##type;
#define DECODE_ARRAY_FOUR(features, type, name, count)                                                           \
    if ((FEATURES & (features)) != 0u) {                                                                         \
        for (int i = 0; i < count; ++i) record.name[i] = type##_FOUR(texels, first, k + i * WORDS_##type);       \
    }                                                                                                            \
    k += WORDS_##type * count;
#define DECODE_OPTIONAL_FOUR(features, absent, type, name)                                  \
    record.name = absent;                                                                   \
    if ((FEATURES & (features)) != 0u) record.name = type##_FOUR(texels, first, k);         \
    k += WORDS_##type;
#define DECODE_FIELD_ONE(type, name)            \
    record.name = type##_ONE(texels, first, k); \
    k += WORDS_##type;

// name_at(index).
#define RECORDS(number, name, Element, per, entries, access, life, hashed)        \
    TEXELS(number, name, Element, per, entries, access, life, hashed)             \
    Element name##_from(usamplerBuffer texels, int first) {                       \
        Element record;                                                           \
        int k = 0;                                                                \
        FIELDS_##Element(DECODE_FIELD_FOUR, DECODE_ARRAY_FOUR, DECODE_OPTIONAL_FOUR) \
        return record;                                                            \
    }                                                                             \
    Element name##_at(uint index) { return name##_from(name##_texels, int(index) * (WORDS_OF(Element) / 4)); }
#define WORD_RECORDS(number, name, Element, per, entries, access, life, hashed)   \
    TEXELS(number, name, Element, per, entries, access, life, hashed)             \
    Element name##_from(usamplerBuffer texels, int first) {                       \
        Element record;                                                           \
        int k = 0;                                                                \
        FIELDS_##Element(DECODE_FIELD_ONE, DECODE_FIELD_ONE, DECODE_FIELD_ONE)    \
        return record;                                                            \
    }                                                                             \
    Element name##_at(uint index) { return name##_from(name##_texels, int(index) * WORDS_OF(Element)); }

#endif
