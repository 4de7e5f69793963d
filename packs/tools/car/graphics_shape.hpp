// The numbers of the body's graphics: outlines in side, front, top and corner views.
//
// Why it exists: like `BodyShape`, the one place where these lines are drawn. Millimetres; plain data.
#pragma once

#include <vector>

#include "packs/tools/car/body_shape.hpp"
#include "packs/tools/car/outline.hpp"

namespace lackwerk::packs::car {

using Corners = std::vector<Corner>;  ///< {{u, v}, radius}

struct GraphicsShape {
  // Side windows: below the roof rail, above the belt line, in front of the C pillar.
  double rail_width_mm = 78.0;  ///< measured down from roof and windscreen surface
  Knots belt_z{{-1500, 1010, 0}, {-600, 978, 300}, {400, 958, 300}, {1000, 946, 0}};
  Corner quarter_tip{{-1330.0, 1030.0}, 0.0};  ///< (x, z) on the line that ends the window
  Vec2 quarter_direction{-0.80, 0.60};         ///< which way that line faces
  double window_corner_mm = 14.0;
  double bright_strip_mm = 13.0;
  double frame_mm = 34.0;  ///< outline of the window graphic to the glass
  double centre_pillar_x_mm = -205.0;
  double centre_pillar_lean = 0.10;  ///< x per z
  double centre_pillar_half_mm = 42.0;
  double rear_pillar_x_mm = -985.0;
  double rear_pillar_half_mm = 20.0;

  // Windscreen and rear window along the roof's x (bowed in plan).
  double front_pillar_mm = 62.0;
  double rear_pillar_mm = 92.0;
  double screen_top_x_mm = 215.0;
  double screen_bottom_mm = -20.0;  ///< of the cabin against the bonnet, negative on the screen
  double cowl_end_mm = 7.0;         ///< likewise, positive on the bonnet
  double rear_top_x_mm = -900.0;
  double rear_bottom_x_mm = -1905.0;
  double screen_corner_mm = 60.0;
  double frit_mm = 26.0;

  // Black lower edge in the side view.
  Knots lower_edge_z{{-2320, 285, 0}, {-1800, 280, 100}, {-1000, 224, 100}, {1000, 214, 100}, {2320, 206, 0}};
  double under_edge_z_mm = 166.0;  ///< below: underbody

  // Corner views: u runs around the corner of the car, v is z.
  double nose_corner_deg = 40.0;
  double tail_corner_deg = 40.0;
  double nose_u_origin_x_mm = 2300.0;
  double tail_u_origin_x_mm = -2300.0;
  Corners head_lamp{{{530, 650}, 10}, {{700, 634}, 60}, {{905, 664}, 30}, {{1000, 722}, 14},
                    {{890, 737}, 60}, {{700, 718}, 80}, {{540, 690}, 12}};
  Corners head_light{{{552, 680}, 3},  {{700, 703}, 60}, {{890, 722}, 60}, {{972, 717}, 4},
                     {{890, 709}, 60}, {{700, 690}, 60}, {{556, 669}, 3}};
  std::vector<Corners> lamp_modules{{{{640, 652}, 7}, {{690, 649}, 7}, {{700, 673}, 7}, {{650, 674}, 7}},
                                    {{{712, 650}, 7}, {{762, 652}, 7}, {{772, 679}, 7}, {{722, 676}, 7}},
                                    {{{784, 655}, 7}, {{834, 662}, 7}, {{844, 687}, 7}, {{794, 682}, 7}}};
  Corners reflector{{{600, 440}, 5}, {{800, 440}, 5}, {{790, 458}, 5}, {{600, 458}, 5}};
  Corners tail_frame{{{-400, 858}, 0}, {{-400, 922}, 0}, {{700, 922}, 100},
                     {{962, 909}, 8},  {{930, 871}, 20}, {{640, 858}, 100}};
  Corners tail_light{{{-400, 876}, 0}, {{-400, 904}, 0}, {{700, 908}, 100},
                     {{940, 899}, 5},  {{920, 881}, 10}, {{640, 874}, 100}};

  // Front view (y, z).
  Corners grille{{{478, 612}, 24},  {{548, 548}, 34},  {{432, 352}, 44},
                 {{-432, 352}, 44}, {{-548, 548}, 34}, {{-478, 612}, 24}};
  Corners side_intake{{{704, 506}, 14}, {{822, 552}, 24}, {{812, 322}, 50}, {{628, 312}, 20}};
  Corners low_intake{{{560, 296}, 20}, {{480, 222}, 30}, {{-480, 222}, 30}, {{-560, 296}, 20}};
  Corners diffuser{{{-700, 405}, 0}, {{570, 405}, 60}, {{705, 283}, 60},
                   {{1200, 279}, 0}, {{1200, 0}, 0},   {{-700, 0}, 0}};

  double grille_frame_mm = 9.0;
  Corners nose_badge{{{-17, 624}, 17}, {{17, 624}, 17}, {{17, 658}, 17}, {{-17, 658}, 17}};
  Corners tail_badge{{{-24, 776}, 24}, {{24, 776}, 24}, {{24, 824}, 24}, {{-24, 824}, 24}};
  Corners plate_recess{{{330, 598}, 26}, {{288, 470}, 26}, {{-288, 470}, 26}, {{-330, 598}, 26}};

  // Shut lines. Side view (x, z).
  double shut_line_half_mm = 2.5;
  Corners doors{{{850, 1200}, 0},  {{905, 800}, 300},  {{900, 420}, 200},   {{800, 240}, 60},
                {{-860, 252}, 80}, {{-985, 500}, 240}, {{-1190, 820}, 300}, {{-1230, 1200}, 0}};
  Corners door_split{{{-215, 1200}, 0}, {{-188, 500}, 600}, {{-190, 200}, 0}};
  Corners front_handle{{{60, 764}, 13}, {{60, 791}, 13}, {{-150, 797}, 13}, {{-150, 770}, 13}};
  Corners rear_handle{{{-830, 792}, 13}, {{-830, 819}, 13}, {{-1040, 825}, 13}, {{-1040, 798}, 13}};
  Corners charge_flap{{{-1590, 838}, 22}, {{-1590, 940}, 22}, {{-1705, 940}, 22}, {{-1705, 838}, 22}};
  // Bonnet: its sides in the top view (x, y), its front edge as a height over |y|.
  Corners bonnet{{{985, -430}, 0},   {{985, 0}, 0},      {{862, 690}, 0},  {{940, 716}, 60}, {{1500, 738}, 300},
                 {{2000, 655}, 200}, {{2190, 560}, 100}, {{2400, 540}, 0}, {{2400, -430}, 0}};
  Knots bonnet_front_z{{0, 664, 0}, {300, 668, 150}, {620, 690, 0}};
  // Tail view (y, z).
  Corners boot{{{575, 1300}, 0}, {{556, 640}, 50}, {{-556, 640}, 50}, {{-575, 1300}, 0}};
  // Top view (x, y): on over the deck, to the corner of the rear window.
  Corners boot_side{{{-1870, 520}, 0}, {{-2080, 566}, 200}, {{-2400, 566}, 0}};
  // Corner views (u, z).
  Corners front_bumper{{{955, 712}, 0}, {{1060, 668}, 120}, {{1300, 560}, 0}};
  // Side view: from the rear wheel opening to the light band.
  Corners rear_bumper{{{-1780, 590}, 0}, {{-1950, 640}, 130}, {{-2060, 862}, 0}};
};

}  // namespace lackwerk::packs::car
