#version 460
// What the fold (host/vk/fold.h) has to do with a kernel: a block each of a shape of control flow or data that the
// constants decide. Items are x; results are words of samples[RESULTS x + block].
#include "include/kernel.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { uint items[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { uint samples[]; };

const bool FIRST = (FEATURES & 1u) != 0u;
const bool SECOND = (FEATURES & 2u) != 0u;

uint mixed(uint x) { return (x ^ x >> 7) * 747796405u + 1u; }

// A phi of which the constants take edges.
uint chosen(uint x) {
    uint value = x;
    if (FIRST) {
        value = mixed(x);
    } else if ((x & 1u) != 0u) {
        value = mixed(x + 1u);
    } else if (SECOND) {
        value = x + 7u;
    }
    return value;
}

// A loop of as many turns as a constant says: none, where it is 0.
uint turned(uint x) {
    uint sum = x;
    for (uint i = 0u; i < STACK; ++i) {
        if ((mixed(x + i) & 3u) == 0u) continue;
        sum += mixed(sum ^ i);
    }
    return sum;
}

// Returns out of loops and selections, which the compiler wraps in a switch.
uint found(uint x) {
    for (uint i = 0u; i < 8u; ++i) {
        uint y = mixed(x + i);
        if (FIRST && (y & 7u) == 3u) return y;
        if ((y & 15u) == 5u) {
            if (SECOND) return i;
            return y + 1u;
        }
    }
    if (x > 40u) return 1u;
    return 2u;
}

// An array that is written and, as the constants have it, never read.
uint kept(uint x) {
    uint entries[6];
    for (uint i = 0u; i < 6u; ++i) entries[i] = mixed(x * 6u + i);
    return FIRST ? entries[x % 6u] : SECOND ? entries[(x + 1u) % 6u] : x;
}

// Operations of which one side decides.
uint decided(uint x) {
    bool is_odd = (x & 1u) != 0u, is_large = x > 100u;
    uint value = 0u;
    if (is_odd && FIRST) value += mixed(x);
    if (is_large || SECOND) value += mixed(x + 2u);
    value += (x & (FIRST ? 0u : ~0u)) * (SECOND ? 1u : 0u);
    return (is_odd && FIRST) || (is_large && SECOND) ? value : value + 3u;
}

// A loop that ends in its first turn or goes round, with what it carries: 18 turns at most, as not all drivers end one
// that goes on.
uint left(uint x) {
    uint a = x, b = 1u, turns = 0u;
    while (true) {
        b += a + 5000u;
        if (!FIRST || b > 90000u) break;
        a = mixed(a) >> 12;
        if (SECOND && a < 20000u) continue;
        ++turns;
    }
    return b + turns;
}

// A selection of which, as the constants have it, neither side comes to its end.
uint skipped(uint x) {
    uint value = x;
    for (uint i = 0u; i < 5u; ++i) {
        if ((mixed(value + i) & 1u) != 0u) {
            value += 3u;
            continue;
        } else {
            value ^= i;
            if (FIRST) continue;
        }
        value = mixed(value) + 11u;
    }
    return value;
}

// A way back that hangs on a constant.
uint repeated(uint x) {
    uint value = x, turns = 0u;
    do {
        value = mixed(value);
        ++turns;
    } while (FIRST && turns < x % 5u);
    return value;
}

// A switch over a constant, with cases that go on into the next.
uint switched(uint x) {
    uint value = x;
    switch (FEATURES & 3u) {
        case 0u: value = mixed(value);
        case 1u: value += 5u; break;
        case 2u:
            if (x > 50u) break;
            value ^= 9u;
        default: value = mixed(value ^ 1u);
    }
    return value;
}

uint mixed(uint value, uvec4 parts) {
    return mixed(mixed(mixed(mixed(value ^ parts.x) ^ parts.y) ^ parts.z) ^ parts.w);
}

// Operations that the fold computes, of constants.
uint computed(uint x) {
    uint a = STACK * 0x20000001u, b = FEATURES + 3u;
    if (SECOND) a = STACK == 1u ? b : ~b - a;
    int s = -int(a), t = -int(b);
    uint value = mixed(x, uvec4(a < b, a <= b, a > b, a >= b));
    value = mixed(value, uvec4(s < t, s <= t, s > t, s >= t));
    value = mixed(value, uvec4(a == b, a != b, FIRST == SECOND, FIRST != (a > 1u)));
    value = mixed(value, uvec4(FIRST || s > 0, FIRST && s < 0, !FIRST, ~a));
    value = mixed(value, uvec4(a + b, a - b, a * b, a / b));
    value = mixed(value, uvec4(a % b, s / (t * t + 2), a >> b, s >> b));
    return mixed(value, uvec4(a << b, a & b, a | b, a ^ b));
}

// Floating-point arithmetic between constants, which the device does.
uint floated(uint x) {
    float third = float(FEATURES & 7u) / 3.0;
    return floatBitsToUint(SECOND ? third * float(x) + 0.1 : sqrt(float(x)) - third);
}

#define RESULTS 11u

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    uint x = items[i];
    samples[RESULTS * i] = chosen(x);
    samples[RESULTS * i + 1u] = turned(x);
    samples[RESULTS * i + 2u] = found(x);
    samples[RESULTS * i + 3u] = kept(x);
    samples[RESULTS * i + 4u] = decided(x);
    samples[RESULTS * i + 5u] = left(x);
    samples[RESULTS * i + 6u] = repeated(x);
    samples[RESULTS * i + 7u] = switched(x);
    samples[RESULTS * i + 8u] = floated(x);
    samples[RESULTS * i + 9u] = computed(x);
    samples[RESULTS * i + 10u] = skipped(x);
}
