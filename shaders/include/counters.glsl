// Regions of the counter buffer, in words. The table of cell starts comes first: the searches index it directly.
// cell starts [cells + 1] | photons a lane, then their offsets [lanes + 1] | radix histogram [digits x columns] |
// sums of scan blocks [scan_blocks].
#define LANE_COUNTS (params.cells + 1u)
#define PHOTON_TOTAL (LANE_COUNTS + params.photon_lanes)
#define RADIX_COUNTS (PHOTON_TOTAL + 1u)
#define SCAN_SUMS (RADIX_COUNTS + (params.sort_lanes << DIGIT_BITS))
