// APPM: Kaplanyan and Dachsbacher 2013, in a form whose units agree. The radius balances variance and squared bias:
// r = [2 R V / (N kappa^2 Delta^2)]^(1/6), V the second moment of the contribution's luminance per area and path, Delta
// the Laplacian of the radiance's luminance, N paths so far. Both are means over iterations; Delta by the five-point
// stencil of the kernel with the pilot bandwidth r_d; luminances times params.flux_unit.
// Uses K(t) = 7/(2 pi) (1 - 10 t^3 + 15 t^4 - 6 t^5).
#include "include/colour.glsl"
#include "include/hits.glsl"
#include "include/pixels.glsl"
#include "include/sampling.glsl"
#include "include/sum.glsl"
#include "estimators/kept.glsl"

const float APPM_KAPPA = 5.0 / 48.0;              // int x_1^2 K
const float APPM_ROUGHNESS = 287.0 / (132.0 * PI);  // int K^2
const float APPM_PILOT = 0.5;                     // r_d = APPM_PILOT r_1 n^(-1/8)
const float APPM_LOW = 0.1;                       // r stays within [LOW, HIGH] r_1 n^(-1/6)
const float APPM_HIGH = 2.0;
const uint APPM_PHOTONS = 10u;                    // r = r_1 until as many were seen

// pi K(t), q = t^2.
#define HOOK_KERNEL_WEIGHT
float kernel_weight(float q) {
    if (q >= 1.0) return 0.0;
    float t = sqrt(q);
    return 3.5 * (1.0 + q * t * (-10.0 + t * (15.0 - 6.0 * t)));
}

float first_radius2(uint pixel) {
    PixelState state = pixels_at(pixel);
    return state.count > 0.0 ? moment_at(APPM_FIRST_RADIUS2, pixel) : state.radius2;
}

// r_d^2 in the iteration at hand, n = count + 1.
float pilot2(uint pixel) {
    return APPM_PILOT * APPM_PILOT * first_radius2(pixel) * pow(pixels_at(pixel).count + 1.0, -0.25);
}

// The stencil reaches a step and a bandwidth far.
#define HOOK_SEARCH_RADIUS2
float search_radius2(uint pixel, float radius2) { return max(radius2, 4.0 * pilot2(pixel)); }

// Sums of this invocation, in the order of APPM_SECOND_MOMENT_NOW and APPM_LAPLACIAN_NOW.
vec2 sums;
// What all its photons share.
float disc_radius2;
float pilot2_now;
vec3 hit_weight_now;

#define HOOK_KEEP STATISTIC_derivative
void keep(uint pixel, Accepted photon, bool inside) {
    float y = luminance(hit_weight_now * photon.power) * (params.inverse_paths * params.flux_unit);
    if (inside) {
        sums.x += y * y * (float(params.photons) * kernel_weight(photon.q) / (PI * disc_radius2));
    }
    // Offset in units of r_d; sum over the four neighbours at distance 1, less four times the centre.
    vec2 e = photon.v * sqrt(disc_radius2 / pilot2_now);
    float stencil = -4.0 * kernel_weight(dot(e, e));
    stencil += kernel_weight(dot(e, e) + 2.0 * e.x + 1.0) + kernel_weight(dot(e, e) - 2.0 * e.x + 1.0);
    stencil += kernel_weight(dot(e, e) + 2.0 * e.y + 1.0) + kernel_weight(dot(e, e) - 2.0 * e.y + 1.0);
    sums.y += y * stencil / (PI * pilot2_now * pilot2_now);
}

#define HOOK_BEGIN
void begin(uint pixel) {
    sums = vec2(moment_at(APPM_SECOND_MOMENT_NOW, pixel), moment_at(APPM_LAPLACIAN_NOW, pixel));
    disc_radius2 = pixels_at(pixel).radius2;
    pilot2_now = pilot2(pixel);
    hit_weight_now = hit_weight_at(pixel).weight;
}

#define HOOK_FLUSH
void flush(uint pixel) {
    moments[row_of(APPM_SECOND_MOMENT_NOW, pixel)] = sums.x;
    moments[row_of(APPM_LAPLACIAN_NOW, pixel)] = sums.y;
}

#define HOOK_UPDATE
void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    state.total = add_saturated(state.total, found);
    if (!diffuse) return;
    float first = sqrt(first_radius2(pixel));
    if (state.count == 0.0) moments[row_of(APPM_FIRST_RADIUS2, pixel)] = state.radius2;
    add(state.count, state.count_low, 1.0);
    float means[2];  // V, Delta
    for (uint row = 0u; row < 2u; ++row) {
        means[row] = moment_at(APPM_SECOND_MOMENT + row, pixel);
        float low = moment_at(APPM_SECOND_MOMENT_LOW + row, pixel);
        average(means[row], low, moment_at(row, pixel), state.count);
        moments[row_of(APPM_SECOND_MOMENT + row, pixel)] = means[row];
        moments[row_of(APPM_SECOND_MOMENT_LOW + row, pixel)] = low;
        moments[row_of(row, pixel)] = 0.0;
    }
    if (state.total < APPM_PHOTONS) return;
    float v = means[0], laplacian = means[1];
    float paths = state.count * float(params.photons);
    // The root first: the quotient itself can leave the range of floats.
    float scale = pow(state.count, -1.0 / 6.0);
    float radius = APPM_HIGH * first * scale;
    if (laplacian != 0.0) {
        float root = pow(2.0 * APPM_ROUGHNESS * v / (paths * APPM_KAPPA * APPM_KAPPA), 1.0 / 6.0) *
                     pow(abs(laplacian), -1.0 / 3.0);
        radius = clamp(root, APPM_LOW * first * scale, APPM_HIGH * first * scale);
    }
    state.radius2 = radius * radius;
}
