#include "kiosk/tools/report/curve_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kiosk/tools/output.hpp"
#include "kiosk/tools/report/pareto.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {
namespace {

using tools::fixed;

constexpr double width = 760, height = 400;
constexpr double left = 78, right = 24, top = 18, bottom = 54;
constexpr double shelf = 26;  ///< room beside a logarithmic axis for values that are 0
/// Distinguishable without colour vision (Okabe & Ito 2008), dark ones first.
constexpr std::array colours = {"#0b5fa5", "#c2410c", "#0f766e", "#8a3b86", "#8a6d00", "#475569"};
constexpr const char* ink = "#1f2430";
constexpr const char* faint = "#e3e6ea";

/// One axis: from figures to pixels.
struct Scale {
  bool logarithmic = false;
  double low = 0.0, high = 1.0;  ///< of the figure, or of its log10
  double from_px = 0.0, to_px = 1.0;
  double zero_px = 0.0;  ///< where 0 lies on a logarithmic axis
  bool zeros = false;
  [[nodiscard]] double at(double value) const {
    if (logarithmic && value <= 0.0) return zero_px;
    const double v = logarithmic ? std::log10(value) : value;
    return from_px + (to_px - from_px) * (v - low) / (high - low);
  }
};

Scale scale_of(std::vector<double> values, double from_px, double to_px) {
  Scale scale;
  std::sort(values.begin(), values.end());
  const auto positive = std::upper_bound(values.begin(), values.end(), 0.0);
  const double smallest = positive != values.end() ? *positive : 0.0;
  const double largest = values.back();
  scale.zeros = positive != values.begin();
  scale.zero_px = from_px;
  const double away = to_px > from_px ? 1.0 : -1.0;
  if (smallest > 0.0 && largest > 8.0 * smallest) {
    scale.logarithmic = true;
    const double margin = 0.04 * (std::log10(largest) - std::log10(smallest)) + 0.02;
    scale.low = std::log10(smallest) - margin;
    scale.high = std::log10(largest) + margin;
    scale.from_px = scale.zeros ? from_px + away * shelf : from_px;
  } else {
    scale.high = largest > 0.0 ? 1.08 * largest : 1.0;
    scale.from_px = from_px;
  }
  scale.to_px = to_px;
  return scale;
}

/// Figures that get a grid line: decades (with 2 and 5 where there are few), or round steps.
std::vector<double> ticks_of(const Scale& scale) {
  std::vector<double> out;
  if (scale.logarithmic) {
    const auto decades = scale.high - scale.low;
    const std::vector<double> within = decades > 3.0   ? std::vector<double>{1.0}
                                       : decades > 1.6 ? std::vector<double>{1.0, 3.0}
                                                       : std::vector<double>{1.0, 2.0, 5.0};
    const int step = decades > 9.0 ? 3 : 1;
    for (int e = static_cast<int>(std::floor(scale.low)); e <= static_cast<int>(std::ceil(scale.high)); e += step)
      for (const double m : within) {
        const double value = m * std::pow(10.0, e);
        const double at = std::log10(value);
        if (at >= scale.low && at <= scale.high) out.push_back(value);
      }
    return out;
  }
  const double raw = scale.high / 5.0;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = raw / decade > 5.0 ? 10.0 * decade : raw / decade > 2.0 ? 5.0 * decade : 2.0 * decade;
  for (int k = 0; k * step <= scale.high * 1.0001; ++k) out.push_back(k * step);
  return out;
}

std::string tick_text(double value) {
  if (value == 0.0) return "0";
  if (value >= 1e5 || value < 1e-3) {
    const int exponent = static_cast<int>(std::floor(std::log10(value) + 1e-9));
    return std::to_string(static_cast<int>(std::lround(value / std::pow(10.0, exponent)))) + "e" +
           std::to_string(exponent);
  }
  std::string text = fixed(value, value < 0.01 ? 4 : value < 0.1 ? 3 : value < 1.0 ? 2 : value < 10.0 ? 1 : 0);
  if (text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string text_at(double x, double y, const std::string& text, const std::string& more) {
  return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" " + more + ">" + markup_escaped(text) + "</text>\n";
}

std::string line_at(double x0, double y0, double x1, double y1, const std::string& more) {
  return "<line x1=\"" + fixed(x0, 1) + "\" y1=\"" + fixed(y0, 1) + "\" x2=\"" + fixed(x1, 1) + "\" y2=\"" +
         fixed(y1, 1) + "\" " + more + "/>\n";
}

/// Around the default.
std::string ring_at(double x, double y) {
  return "<circle cx=\"" + fixed(x, 1) + "\" cy=\"" + fixed(y, 1) + "\" r=\"9\" fill=\"none\" stroke=\"" + ink +
         "\" stroke-width=\"2\"/>\n";
}

double price_of(const Setting& setting, Price price) {
  return price == Price::time ? setting.time.median_ms : setting.bytes;
}

struct Placed {
  const Setting* setting;
  double x, y;
};

/// The error's name beside its axis: up to a colon (the caption has the rest), in two lines where one is longer than
/// the axis (some 44 letters of 5.6 px on 250 px).
std::vector<std::string> upright_title(const std::string& error_unit) {
  constexpr std::size_t longest = 44;
  const std::string text = error_unit.substr(0, error_unit.find(':'));
  if (text.size() <= longest) return {text};
  const std::size_t cut = text.rfind(' ', text.size() / 2 + 4);
  if (cut == std::string::npos) return {text};
  return {text.substr(0, cut), text.substr(cut + 1)};
}

std::string axes(const Knob& knob, Price price, const Scale& x, const Scale& y, double foot_px) {
  const double floor_px = foot_px - bottom;
  std::string out;
  const std::string grid = std::string("stroke=\"") + faint + "\"";
  for (const double tick : ticks_of(x)) {
    out += line_at(x.at(tick), top, x.at(tick), floor_px, grid);
    out += text_at(x.at(tick), floor_px + 17, tick_text(tick), "text-anchor=\"middle\"");
  }
  for (const double tick : ticks_of(y)) {
    out += line_at(left, y.at(tick), width - right, y.at(tick), grid);
    out += text_at(left - 8, y.at(tick) + 4, tick_text(tick), "text-anchor=\"end\"");
  }
  if (y.logarithmic && y.zeros) {
    out += line_at(left, y.zero_px, width - right, y.zero_px, grid);
    out += text_at(left - 8, y.zero_px + 4, "0", "text-anchor=\"end\"");
  }
  const std::string x_title =
      price == Price::time ? "ms: " + knob.time_of + " (median, quartiles)" : "bytes: " + knob.bytes_of;
  out += text_at(0.5 * (left + width - right), foot_px - 14, x_title, "text-anchor=\"middle\" font-weight=\"500\"");
  const std::vector<std::string> title = upright_title(knob.error_unit);
  for (std::size_t k = 0; k < title.size(); ++k) {
    const double x_px = title.size() == 1 ? 16.0 : 10.0 + 15.0 * static_cast<double>(k);
    out += text_at(0, 0, title[k],
                   "text-anchor=\"middle\" font-weight=\"500\" transform=\"translate(" + fixed(x_px, 1) + " " +
                       fixed(0.5 * (top + floor_px), 1) + ") rotate(-90)\"");
  }
  return out;
}

/// Where a label stands beside its point: right, left, above or below, the first place where it covers nothing.
class LabelPlaces {
 public:
  explicit LabelPlaces(const std::vector<Placed>& points) {
    taken_.reserve(2 * points.size());
    for (const Placed& p : points) taken_.push_back({p.x - 5, p.y - 5, p.x + 5, p.y + 5});
  }
  std::string put(const Placed& point, const std::string& label, const char* colour, bool bold) {
    const double w = 6.4 * static_cast<double>(label.size()) + 4.0;
    const std::array<std::array<double, 3>, 6> tries = {
        {{9, 4, 0}, {-9, 4, 1}, {0, -10, 2}, {0, 19, 2}, {9, -8, 0}, {-9, -8, 1}}};
    for (const auto& [dx, dy, anchor] : tries) {
      const double x0 = point.x + dx - (anchor == 1 ? w : anchor == 2 ? w / 2 : 0.0);
      const Box box{x0, point.y + dy - 10, x0 + w, point.y + dy + 3};
      if (box.x0 < left || box.x1 > width - 2 || box.y0 < 2) continue;
      if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.meets(other); })) continue;
      taken_.push_back(box);
      return text_at(point.x + dx, point.y + dy, label,
                     std::string("fill=\"") + colour + "\" text-anchor=\"" +
                         (anchor == 1   ? "end"
                          : anchor == 2 ? "middle"
                                        : "start") +
                         "\"" + (bold ? " font-weight=\"700\"" : ""));
    }
    return {};  // crowded: the table has it
  }

 private:
  struct Box {
    double x0, y0, x1, y1;
    [[nodiscard]] bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
  };
  std::vector<Box> taken_;
};

}  // namespace

std::string markup_escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : tools::one_line(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string curve_svg(const Knob& knob, Price price) {
  std::vector<double> prices, errors;
  std::vector<std::string> names;
  for (const Setting& setting : knob.settings) {
    if (!std::isfinite(price_of(setting, price)) || !std::isfinite(setting.error)) continue;
    prices.push_back(price_of(setting, price));
    errors.push_back(setting.error);
    if (std::find(names.begin(), names.end(), setting.line) == names.end()) names.push_back(setting.line);
  }
  if (prices.size() < 2) return {};
  // One row of legend for each two lines, below the axis.
  const bool legend = names.size() > 1;
  const std::size_t legend_rows = (names.size() + 1) / 2;
  const double legend_px = legend ? 20.0 * static_cast<double>(legend_rows) + 6.0 : 0.0;
  const Scale x = scale_of(prices, left, width - right);
  const Scale y = scale_of(errors, height - bottom, top);

  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(width, 0) + " " +
                    fixed(height + legend_px, 0) + "\" width=\"" + fixed(width, 0) + "\" height=\"" +
                    fixed(height + legend_px, 0) +
                    "\" font-family=\"Inter, 'Helvetica Neue', Arial, sans-serif\" font-size=\"12\" fill=\"" + ink +
                    "\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  out += axes(knob, price, x, y, height);

  const auto front = price == Price::time ? pareto_front(knob.settings) : pareto_front_of_bytes(knob.settings);
  std::string steps;
  double last_y = 0.0;
  for (const std::size_t k : front) {
    const double px = x.at(price_of(knob.settings[k], price)), py = y.at(knob.settings[k].error);
    if (!steps.empty()) steps += fixed(px, 1) + "," + fixed(last_y, 1) + " ";
    steps += fixed(px, 1) + "," + fixed(py, 1) + " ";
    last_y = py;
  }
  out += "<polyline fill=\"none\" stroke=\"#94a3b8\" stroke-width=\"6\" stroke-opacity=\"0.35\" points=\"" + steps +
         "\"/>\n";

  std::vector<Placed> all;
  all.reserve(knob.settings.size());
  for (std::size_t n = 0; n < names.size(); ++n) {
    const char* colour = colours[n % colours.size()];
    std::string path, marks;
    for (const Setting& setting : knob.settings) {
      const double cost = price_of(setting, price);
      if (setting.line != names[n] || !std::isfinite(cost) || !std::isfinite(setting.error)) continue;
      const Placed point{&setting, x.at(cost), y.at(setting.error)};
      all.push_back(point);
      path += fixed(point.x, 1) + "," + fixed(point.y, 1) + " ";
      if (price == Price::time && setting.time.high_ms > setting.time.low_ms)
        marks += line_at(std::max(x.at(setting.time.low_ms), left), point.y,
                         std::min(x.at(setting.time.high_ms), width - right), point.y,
                         std::string("stroke=\"") + colour + "\" stroke-width=\"1.5\"");
      const std::string fill = setting.eligible ? colour : "#ffffff";
      marks += "<circle cx=\"" + fixed(point.x, 1) + "\" cy=\"" + fixed(point.y, 1) + "\" r=\"4\" fill=\"" + fill +
               "\" stroke=\"" + colour + "\" stroke-width=\"1.5\"><title>" +
               markup_escaped(setting.label + ": error " + digits(setting.error) + ", " +
                              (price == Price::time ? digits(cost) + " ms" : digits(cost) + " bytes")) +
               "</title></circle>\n";
      if (setting.label == knob.chosen) marks.append(ring_at(point.x, point.y));
    }
    out += "<polyline fill=\"none\" stroke=\"" + std::string(colour) + "\" stroke-width=\"1.5\" points=\"" + path +
           "\"/>\n";
    out += marks;
    if (legend) {
      const double lx = left + (n % 2 == 0 ? 0.0 : 0.5 * (width - left - right));
      const std::size_t row = n / 2;
      const double ly = height + 8.0 + 20.0 * static_cast<double>(row);
      out += line_at(lx, ly, lx + 22, ly, std::string("stroke=\"") + colour + "\" stroke-width=\"3\"");
      out += text_at(lx + 30, ly + 4, names[n].empty() ? knob.title : names[n], "");
    }
  }
  LabelPlaces places(all);
  // The default and the front first: they must not lose their names to the crowd.
  std::vector<std::size_t> order(all.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto rank = [&](std::size_t k) {
    if (all[k].setting->label == knob.chosen) return 0;
    const auto index = static_cast<std::size_t>(all[k].setting - knob.settings.data());
    return std::find(front.begin(), front.end(), index) != front.end() ? 1 : 2;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t one, std::size_t two) { return rank(one) < rank(two); });
  for (const std::size_t k : order) {
    const auto place = std::find(names.begin(), names.end(), all[k].setting->line);
    const char* colour = colours[static_cast<std::size_t>(place - names.begin()) % colours.size()];
    out += places.put(all[k], all[k].setting->label, colour, all[k].setting->label == knob.chosen);
  }
  return out + "</svg>\n";
}

}  // namespace lackwerk::report
