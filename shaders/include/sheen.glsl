// Sheen of fibres that stand off a surface (KHR_materials_sheen): how their normals are distributed, how they hide one
// another (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"), and the share of light that they
// reflect. Pure functions.
#ifndef SHEEN_GLSL
#define SHEEN_GLSL

#include "include/kernel.glsl"
#include "include/sampling.glsl"

// Below, sheen is seen within a few degrees of grazing alone, where its formula reflects more than arrives.
const float LEAST_SHEEN_ROUGHNESS = 0.07;
// Of cosines: an infinity divided by another is no number.
const float LEAST_SHEEN_COSINE = 1e-5;

// The sheen of a surface.
struct Sheen {
    vec3 color;
    float most;     // largest channel of the colour; 0: there is none
    float alpha;    // width of the distribution
    vec4 low;       // of sheen_albedo: the polynomial's coefficients of powers 0 to 3,
    vec4 high;      //   and 4 to 7
};

// As one direction sees it.
struct SheenSide {
    float cosine;
    float lambda;   // Smith's
    float albedo;   // share of light from everywhere that it sends there; at most 1
    float excess;   // how many times that the formula would: 1 where it keeps to what arrives
};

// The share of light that it reflects, E = integral of D V cos, is exp(p) / (4 cos (1 + Lambda)): without that factor
// the integral is smooth. p is a polynomial in x = 2 sqrt(cos) - 1, whose coefficients are polynomials in y, the
// logarithm of alpha from its least (-1) to 1 (+1). Fitted by tests/bench/sheen_albedo, which integrates in double
// precision: off by at most 8e-4, of E where that is above 1.
void fit_sheen_albedo(inout Sheen s) {
    float y = 1.0 - log(s.alpha) / log(LEAST_SHEEN_ROUGHNESS);
    s.low = vec4(0.432712, -2.487856, -1.339953, -0.377088) +
        y * (vec4(0.515830, 3.426631, 2.244219, 1.067669) +
        y * (vec4(-0.932559, -2.267003, -1.740972, -2.309629) +
        y * (vec4(0.569307, 1.125806, 1.900830, 3.962272) +
        y * (vec4(-0.152946, -1.003114, -3.134332, -5.237860) +
        y * (vec4(0.193747, 1.267522, 3.425001, 4.787070) +
        y * vec4(-0.153181, -0.680115, -1.459140, -1.871307))))));
    s.high = vec4(-0.312929, -0.987052, -0.948515, -0.164292) +
        y * (vec4(1.922634, 2.337150, 0.494848, -0.452690) +
        y * (vec4(-4.169869, -1.790496, 2.448847, 1.816115) +
        y * (vec4(4.194149, 0.018031, -2.506501, -1.060755) +
        y * (vec4(-3.712357, 0.029474, 1.246941, 0.422413) +
        y * (vec4(3.084125, -0.354106, -1.839725, -0.828730) +
        y * vec4(-1.087854, 0.555235, 1.075148, 0.378904))))));
}

Sheen sheen_of(vec3 color, float roughness) {
    Sheen s;
    s.color = color;
    s.most = max(color.r, max(color.g, color.b));
    float r = max(roughness, LEAST_SHEEN_ROUGHNESS);
    s.alpha = r * r;
    fit_sheen_albedo(s);
    return s;
}

Sheen no_sheen() { return Sheen(vec3(0.0), 0.0, 1.0, vec4(0.0), vec4(0.0)); }

// The logarithm of Lambda up to a cosine of 1/2, beyond which it is that of a half twice, less that of 1 - cosine.
float log_sheen_lambda(float cosine, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    float a = mix(21.5473, 25.3245, t);
    float b = mix(3.82987, 3.32435, t);
    float c = mix(0.19823, 0.16801, t);
    float d = mix(-1.97760, -1.27393, t);
    float e = mix(-4.32054, -4.85967, t);
    return a / (1.0 + b * pow(cosine, c)) + d * cosine + e;
}

// cosine: to the surface's normal, of either sign.
SheenSide sheen_side(Sheen s, float cosine) {
    SheenSide side;
    side.cosine = clamp(abs(cosine), LEAST_SHEEN_COSINE, 1.0);
    bool flat_angle = side.cosine < 0.5;
    float exponent = log_sheen_lambda(flat_angle ? side.cosine : max(1.0 - side.cosine, 1e-30), s.alpha);
    side.lambda = exp(flat_angle ? exponent : 2.0 * log_sheen_lambda(0.5, s.alpha) - exponent);
    float x = 2.0 * sqrt(side.cosine) - 1.0;
    float p = s.high.w;
    p = p * x + s.high.z;
    p = p * x + s.high.y;
    p = p * x + s.high.x;
    p = p * x + s.low.w;
    p = p * x + s.low.z;
    p = p * x + s.low.y;
    p = p * x + s.low.x;
    float albedo = exp(p) / (4.0 * side.cosine * (1.0 + side.lambda));
    side.albedo = min(1.0, albedo);
    side.excess = max(1.0, albedo);
    return side;
}

// What it leaves to what lies below: the specification's albedo scaling.
float below_sheen(Sheen s, SheenSide o, SheenSide i) { return 1.0 - s.most * max(o.albedo, i.albedo); }

// Its BSDF. sin2_h: of the angle between half vector and normal. The formula reflects more than arrives where roughness
// is below 0.25 and a direction within some degrees of grazing; there it is brought down to all.
vec3 sheen_value(Sheen s, SheenSide o, SheenSide i, float sin2_h) {
    float distribution = (2.0 + 1.0 / s.alpha) * pow(sin2_h, 0.5 / s.alpha) / (2.0 * PI);
    float visibility = 1.0 / (4.0 * o.cosine * i.cosine * (1.0 + o.lambda + i.lambda));
    return s.color * (distribution * visibility / max(o.excess, i.excess));
}

#endif
