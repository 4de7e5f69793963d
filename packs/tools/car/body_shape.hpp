// The numbers of the body: silhouette, plan, sections. Every length in millimetres, every slope in mm per mm.
//
// Why it exists: a designer changes the car here and nowhere else. The struct is plain data, owned by whoever makes
// one; no thread concerns.
#pragma once

#include <vector>

#include "packs/tools/car/soft_math.hpp"

namespace lackwerk::packs::car {

using Knots = std::vector<ProfileKnot>;  ///< {at, value, rounding}

struct WheelLayout {
  double front_axle_x_mm = 1430.0;
  double rear_axle_x_mm = -1430.0;
  double centre_z_mm = 356.0;     ///< tyre radius: the car stands on z = 0
  double tyre_radius_mm = 356.0;  ///< 255/40 R20
  double tyre_width_mm = 258.0;
  double outer_face_y_mm = 912.0;  ///< tyre flank, a little inside the arch
  double arch_radius_mm = 386.0;
  double well_inner_y_mm = 560.0;  ///< the arch cut ends here under the floor
};

/// The lower body: flank, bonnet and decks, nose, tail, floor.
struct LowerBodyShape {
  // Plan: half width at the shoulder line over x.
  Knots plan_half_width{{-2330, 838, 0}, {-1900, 906, 300}, {-1430, 936, 400}, {-500, 939, 600},
                        {500, 936, 600}, {1430, 928, 400},  {1900, 914, 250},  {2330, 850, 0}};
  // Height of the shoulder line over x: the wedge.
  Knots shoulder_z{{-2300, 884, 0}, {-1430, 858, 500}, {1400, 770, 500}, {2300, 716, 0}};
  // Rounding of the shoulder line: crisp on the doors, melting into lamps at both ends.
  Knots shoulder_rounding{{-2300, 40, 0}, {-1500, 18, 300}, {900, 16, 300}, {1700, 50, 200}, {2300, 90, 0}};
  double upper_lean = 0.36;            ///< flank above the shoulder line leans in
  double upper_crown_per_mm = 0.0006;  ///< and more so further up
  /// Flank below the shoulder line falls in on its way down, on the doors more than on the bumpers.
  Knots lower_undercut{{-2000, 0.02, 0}, {-1300, 0.08, 300}, {1300, 0.10, 300}, {1900, 0.02, 0}};
  double door_crown_per_mm = 0.00009;  ///< the door's section is bowed about this height
  double door_crown_z_mm = 640.0;
  double sill_flare = 0.29;  ///< then turns out again: the light catcher
  double sill_flare_rounding_mm = 75.0;
  Knots sill_flare_z{{-1400, 512, 0}, {0, 430, 400}, {1400, 380, 0}};
  double sill_roll_z_mm = 225.0;  ///< under this the sill turns under the car
  double sill_roll = 1.1;
  double sill_roll_rounding_mm = 30.0;

  // Blisters over the wheels: cones around the axle.
  double blister_half_width_front_mm = 938.0;
  double blister_half_width_rear_mm = 944.0;
  double blister_start_radius_mm = 392.0;
  double blister_slope = 0.24;
  double blister_rounding_mm = 75.0;
  double blister_blend_mm = 46.0;
  double blister_low_z_mm = 330.0;  ///< under this the blister falls in towards the sill
  double blister_low_slope = 0.17;

  // Bonnet, shelf beside the cabin, boot lid: height at the centre line over x.
  Knots deck_z{{-2330, 1004, 0}, {-2000, 1000, 120}, {-1400, 992, 300}, {-600, 974, 400}, {400, 962, 300},
               {1000, 962, 200}, {1450, 918, 300},   {1900, 842, 250},  {2190, 758, 130}, {2330, 655, 0}};
  double deck_crown_per_mm = 0.00009;  ///< z falls with y squared
  // Bonnet crease (half distance from centre) and how much the surface kicks up there.
  Knots bonnet_crease_y{{-400, 700, 0}, {800, 640, 300}, {2300, 430, 0}};
  Knots bonnet_crease_kick{{-600, 0.0, 0}, {600, 0.02, 300}, {1300, 0.12, 400}, {2400, 0.11, 0}};
  double bonnet_crease_rounding_mm = 60.0;
  // Fender crest: from here outward the top falls towards the flank.
  Knots fender_crest_y{{-2300, 690, 0}, {-1400, 770, 400}, {0, 800, 500}, {1400, 760, 400}, {2300, 650, 0}};
  double fender_fall = 0.42;
  double fender_crest_rounding_mm = 130.0;
  Knots deck_edge_rounding{{-2300, 60, 0}, {-1400, 120, 300}, {-600, 60, 300}, {900, 60, 300}, {1500, 110, 0}};

  // Nose: x of the face over z at the centre line, and its sweep back over y.
  Knots nose_x{{120, 2190, 0}, {225, 2270, 30}, {470, 2300, 90}, {628, 2290, 26}, {760, 2195, 60}, {900, 2060, 0}};
  double nose_sweep_per_mm = 0.00021;
  double nose_corner_y_mm = 640.0;
  double nose_corner_sweep = 0.52;
  double nose_corner_rounding_mm = 150.0;
  double nose_edge_mm = 52.0;    ///< fillet bonnet to face
  double nose_flank_mm = 105.0;  ///< fillet face to flank

  // Tail likewise; x is measured backwards (positive to the rear).
  Knots tail_x{{150, 2130, 0},  {300, 2235, 60}, {480, 2296, 70}, {640, 2290, 70},
               {800, 2252, 90}, {920, 2262, 90}, {1040, 2296, 0}};
  double tail_sweep_per_mm = 0.00016;
  double tail_corner_y_mm = 640.0;
  double tail_corner_sweep = 0.52;
  double tail_corner_rounding_mm = 120.0;
  double tail_edge_mm = 26.0;
  double tail_flank_mm = 105.0;

  Knots floor_z{{-2330, 300, 0}, {-1750, 165, 150}, {1700, 150, 150}, {2330, 190, 0}};
  double floor_edge_mm = 30.0;
};

/// The cabin that stands on the lower body.
struct CabinShape {
  Knots plan_half_width{{-2330, 520, 0}, {-1700, 668, 300}, {-1100, 782, 400}, {-300, 838, 500},
                        {400, 836, 400}, {950, 770, 300},   {1500, 640, 0}};
  double bottom_z_mm = 790.0;  ///< hidden inside the lower body
  double belt_z_mm = 950.0;    ///< where plan_half_width is measured
  double tumblehome = 0.30;
  double tumblehome_gain_per_mm = 0.00040;
  // Windscreen, roof, rear window in one sweep: z over x at the centre line.
  Knots roof_z{{-2330, 560, 0},   {-2085, 1016, 60}, {-1800, 1128, 300}, {-1350, 1282, 350},
               {-820, 1428, 350}, {-260, 1466, 300}, {270, 1388, 150},   {1300, 802, 0}};
  Knots plan_sweep_per_mm{{-1500, -0.00018, 0}, {-700, -0.00008, 300}, {0, 0.00004, 300}, {700, 0.00022, 0}};
  double roof_crown_per_mm = 0.00009;
  Knots rail_rounding{{-2000, 90, 0}, {-600, 110, 300}, {300, 110, 200}, {1000, 70, 0}};
  Knots waist_rounding{{-2200, 60, 0}, {-1400, 70, 300}, {-600, 26, 300}, {700, 24, 200}, {1200, 40, 0}};
};

struct BodyShape {
  WheelLayout wheels;
  LowerBodyShape lower;
  CabinShape cabin;
  double symmetry_rounding_mm = 90.0;  ///< |y| is rounded so that nothing creases along the centre line
};

}  // namespace lackwerk::packs::car
