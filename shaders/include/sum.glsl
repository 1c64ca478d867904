// Sums of very many terms, and what must not take part in one. Pure functions.
#ifndef SUM_GLSL
#define SUM_GLSL

// Adds `value` to the sum of two floats, `low` below half an ulp of `sum` (Dekker 1971): 10^6 additions err by 10^6
// 2^-47 of the sum. A `low` that is only added to (Neumaier 1974) grows until its own rounding shows, with the square
// of their number.
void add(inout float sum, inout float low, float value) {
    precise float total = sum + value;
    precise float lost = abs(sum) >= abs(value) ? (sum - total) + value : (value - total) + sum;
    precise float carried = low + lost;
    precise float renewed = total + carried;
    precise float rest = carried - (renewed - total);
    sum = renewed;
    low = rest;
}

void add(inout vec3 sum, inout vec3 low, vec3 value) {
    add(sum.x, low.x, value.x);
    add(sum.y, low.y, value.y);
    add(sum.z, low.z, value.z);
}

// The same for fewer terms, in half the operations: `excess` is what `sum` has too much (Kahan 1965).
void add_corrected(inout vec3 sum, inout vec3 excess, vec3 value) {
    precise vec3 corrected = value - excess;
    precise vec3 total = sum + corrected;
    precise vec3 rest = (total - sum) - corrected;
    sum = total;
    excess = rest;
}

// Takes one more of `count` values into the mean of two floats.
void average(inout float mean, inout float low, float value, float count) {
    add(mean, low, ((value - mean) - low) / count);
}

// Adds to a counter that stays at its largest value instead of starting again at 0.
uint add_saturated(uint counter, uint value) {
    uint sum = counter + value;
    return sum < counter ? 0xffffffffu : sum;
}

bool finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

bool finite(vec3 v) { return finite(v.x) && finite(v.y) && finite(v.z); }

#endif
