// What the eye pass leaves a pixel, one array a record.
layout(binding = BIND_HIT_POSITION, scalar) buffer HitPositionBlock { HitPosition hit_position[]; };
layout(binding = BIND_HIT_WEIGHT, scalar) buffer HitWeightBlock { HitWeight hit_weight[]; };
layout(binding = BIND_HIT_EMISSION, scalar) buffer HitEmissionBlock { HitEmission hit_emission[]; };
layout(binding = BIND_GATHERED, scalar) buffer GatheredBlock { Gathered gathered[]; };
