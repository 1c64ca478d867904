// The scene's buffers, read through texels: 1.6 times faster than storage buffers on software Vulkan.
layout(binding = BIND_NODES) uniform usamplerBuffer nodes;
layout(binding = BIND_TRIANGLES) uniform samplerBuffer triangles;
layout(binding = BIND_SHADING) uniform usamplerBuffer shading;
layout(binding = BIND_MATERIALS, scalar) readonly buffer MaterialBlock { SurfaceMaterial materials[]; };
