#include "kiosk/tools/svg_plot.hpp"

#include <algorithm>

#include "kiosk/tools/output.hpp"

namespace lackwerk::tools {
namespace {

constexpr int panel_width = 480, panel_height = 400;
constexpr int left = 60, right = 20, top = 40, bottom = 90;
constexpr int grid_lines = 5;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : one_line(text)) {
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
      default:
        out += c;
    }
  }
  return out;
}

std::string text_at(double x, double y, const std::string& text, const char* anchor, const char* more = "") {
  return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         escaped(text) + "</text>\n";
}

std::string line_at(double x0, double y0, double x1, double y1, const char* colour, int width) {
  return "<line x1=\"" + fixed(x0, 1) + "\" y1=\"" + fixed(y0, 1) + "\" x2=\"" + fixed(x1, 1) + "\" y2=\"" +
         fixed(y1, 1) + "\" stroke=\"" + colour + "\" stroke-width=\"" + std::to_string(width) + "\"/>\n";
}

std::string panel_text(const Plot& plot, double offset) {
  const double width = panel_width - left - right, height = panel_height - top - bottom;
  const auto at_x = [&](double x) { return offset + left + width * std::clamp(x / plot.x_end, 0.0, 1.0); };
  const auto at_y = [&](double y) { return top + height * (1.0 - std::clamp(y / plot.y_end, 0.0, 1.0)); };
  std::string out;
  for (int k = 0; k <= grid_lines; ++k) {
    const double x = plot.x_end * k / grid_lines, y = plot.y_end * k / grid_lines;
    out += line_at(at_x(x), top, at_x(x), top + height, "#dddddd", 1);
    out += line_at(at_x(0), at_y(y), at_x(plot.x_end), at_y(y), "#dddddd", 1);
    out += text_at(at_x(x), top + height + 18, fixed(x, plot.x_end < 10 ? 1 : 0), "middle");
    out += text_at(at_x(0) - 6, at_y(y) + 4, fixed(y, 1), "end");
  }
  out += text_at(offset + left + width / 2, 22, plot.title, "middle", " font-size=\"14\"");
  out += text_at(offset + left + width / 2, panel_height - bottom + 36, plot.x_label, "middle");
  const std::string turned =
      " transform=\"rotate(-90 " + fixed(offset + 16, 1) + " " + fixed(top + height / 2, 1) + ")\"";
  out += text_at(offset + 16, top + height / 2, plot.y_label, "middle", turned.c_str());
  double legend = panel_height - bottom + 58;
  for (const PlotLine& line : plot.lines) {
    out += std::string("<polyline fill=\"none\" stroke=\"") + line.colour + "\" stroke-width=\"2\" points=\"";
    for (const auto& [x, y] : line.points) out += fixed(at_x(x), 2) + "," + fixed(at_y(y), 2) + " ";
    out += "\"/>\n";
    if (line.marks)
      for (const auto& [x, y] : line.points)
        out += "<circle cx=\"" + fixed(at_x(x), 2) + "\" cy=\"" + fixed(at_y(y), 2) + "\" r=\"3\" fill=\"" +
               line.colour + "\"/>\n";
    out += line_at(offset + left, legend - 4, offset + left + 24, legend - 4, line.colour, 2);
    out += text_at(offset + left + 32, legend, line.label, "start");
    legend += 18;
  }
  return out;
}

}  // namespace

std::string svg_text(const std::vector<Plot>& panels) {
  const std::string width = std::to_string(panel_width * static_cast<int>(panels.size()));
  const std::string height = std::to_string(panel_height);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                    "\" viewBox=\"0 0 " + width + " " + height +
                    "\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n<rect width=\"100%\" "
                    "height=\"100%\" fill=\"#ffffff\"/>\n";
  for (std::size_t k = 0; k < panels.size(); ++k) out += panel_text(panels[k], static_cast<double>(k) * panel_width);
  return out + "</svg>\n";
}

}  // namespace lackwerk::tools
