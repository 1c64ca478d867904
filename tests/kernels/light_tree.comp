#version 460
// Lamps of a light tree: which one a word chooses at a point, and how likely another is there. launch.argument: depth
// of the tree.
#include "include/kernel.glsl"
#include "include/light_tree.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { LampInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { LampOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    LampInput at = inputs[i];
    uint word = at.word;
    Lamp lamp = choose_lamp(AskedGroup(0u, 0u, 1u, launch.argument), at.position, word, at.v);
    outputs[i] = LampOutput(lamp.first, lamp.count, lamp.probability, word, lamp_probability(at.lamp, at.position));
}
