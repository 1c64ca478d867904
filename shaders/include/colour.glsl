// Colours in linear Rec. 709. Pure functions.
#ifndef COLOUR_GLSL
#define COLOUR_GLSL

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Relative luminance.
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

#endif
