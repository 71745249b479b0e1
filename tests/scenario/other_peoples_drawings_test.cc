// SPDX-License-Identifier: BSD-3-Clause
// Drawings as other programs write them: walls where their authors see them, or words that say why
// not.
#include <gtest/gtest.h>

#include <fstream>

#include "core/motion/walls.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;
using Places = std::vector<Eigen::Vector2d>;

/// A drawing of 40 × 30 units, which are metres. Its content begins on line 2.
std::string page_of(const std::string& content, const std::string& more = "") {
  return R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" )"
         R"(viewBox="0 0 40 30" )" +
         more + ">\n" + content + "\n</svg>";
}

class OtherPeoplesDrawings : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }
  Loaded walls_of(const std::string& svg, const std::string& more) const {
    write("floor.svg", svg);
    write("mine.textproto",
          "domain { size_x_m: 40 size_y_m: 30 }\ntarget { uniform_weight: 1 }\n"
          "world { speed_limit_mps: 1000 walls { file: \"floor.svg\" " +
              more +
              " } }\nlaw { u_max_mps: 5 }\ntime { duration_s: 60 }\n"
              "agents { starts { x_m: 0.5 y_m: 0.5 } }\n");
    return Scenario::load(folder_.path() / "mine.textproto");
  }
  /// At places of the drawing, y down.
  void expect_walls(const std::string& svg, const Places& solid, const Places& free,
                    const std::string& more = "") const {
    const Loaded loaded = walls_of(svg, more);
    ASSERT_TRUE(loaded) << svg << '\n' << joined(loaded.error());
    const Rings& walls = loaded->mission().walls;
    for (const auto& [places, is_solid] : {std::pair(&solid, true), std::pair(&free, false)})
      for (const Eigen::Vector2d& at : *places)
        EXPECT_EQ(solid_at(walls, {at.x(), 30 - at.y()}), is_solid)
            << at.transpose() << " of " << svg;
  }
  void expect_refused(const std::string& svg, const std::string& words) const {
    const Loaded loaded = walls_of(svg, "");
    ASSERT_FALSE(loaded) << svg;
    const std::string said = joined(loaded.error());
    EXPECT_TRUE(has(said, "mine.textproto:3:39: world.walls[0].file: "));
    EXPECT_TRUE(has(said, words)) << svg;
  }

  const TempFolder folder_;
};

struct Drawn {
  std::string content;
  Places solid, free;
};

/// From (10, 5) to (20, 15), and (30, 20) always free.
const Places kBox = {{10.1, 5.1}, {15, 10}, {19.9, 14.9}};
const Places kAround = {{9.9, 10}, {20.1, 10}, {15, 4.9}, {15, 15.1}, {30, 20}};

TEST_F(OtherPeoplesDrawings, BoxesAreWhereEveryProgramShowsThem) {
  const std::string box = "<rect x='10' y='5' width='10' height='10'/>";
  const std::string page = "<rect width='40' height='30' ";
  const std::vector<std::string> contents = {
      box,
      "<g transform='translate(10,5)'><rect width='10' height='10'/></g>",
      "<style>.w{fill:#333}</style><g fill='none'><rect class='w' x='10' y='5' width='10' "
      "height='10'/></g>",
      "<style>#w{fill:#333 !important}</style><rect id='w' fill='none' x='10' y='5' width='10' "
      "height='10'/>",
      "<style>.w{transform:translate(10px,5px)}</style><rect class='w' width='10' height='10'/>",
      "<style>.w{display:none}</style><rect class='w' width='40' height='30'/>" + box,
      page + "visibility='hidden'/>" + box,
      page + "fill='white'/>" + box,
      page + "fill='transparent'/>" + box,
      page + "fill='rgba(0,0,0,0)'/>" + box,
      page + "fill='#00000000'/>" + box,
      page + "fill='ivory'/>" + box,
      page + "opacity='0'/>" + box,
      "<rect x='10' y='5' width='10' height='10' fill='#3338'/>",
      "<rect x='10' y='5' width='10' height='10' fill='yellow'/>",
      "<rect x='25%' y='5' width='25%' height='10'/>",
      "<rect x='10' y='5' width='2.6458333mm' height='10px'/>",
      "<switch><g>" + box + "</g></switch>",
      "<svg x='10' y='5' width='20' height='10' viewBox='0 0 40 20'>"
      "<rect width='20' height='20'/></svg>",
      "<defs><rect id='r' width='10' height='10'/></defs><use href='#r' x='10' y='5'/>",
      "<symbol id='r' viewBox='0 0 1 1'><rect width='1' height='1'/></symbol>"
      "<use xlink:href='#r' x='10' y='5' width='10' height='10'/>",
      "<clipPath id='c'>" + box + "</clipPath>" + page + "clip-path='url(#c)'/>",
      "<mask id='c'><rect x='10' y='5' width='10' height='10' fill='white'/></mask>" + page +
          "mask='url(#c)'/>",
      "<linearGradient id='f'><stop/><stop offset='1' stop-color='red'/></linearGradient>"
      "<rect x='10' y='5' width='10' height='10' fill='url(#f)'/>",
      "<line x1='15' y1='5' x2='15' y2='15' stroke='red' stroke-width='10'/>",
      "<style>.w{stroke:#000;stroke-width:10}</style><polyline class='w' points='10,10 20,10'/>",
      "<path d='M10 5H20V15H10z'/><path d='M12 7h4v4h-4z'/>",
      "<path d='M10 5H20V15H10z M12 7h4v4h-4z'/>",
      "<rect x='10' y='5' width='6' height='10'/><rect x='15' y='5' width='5' height='10'/>",
      "<rect x='10' y='5' width='6' height='10'/><rect x='16' y='5' width='4' height='10'/>",
      "<a href='https://example.org'>" + box + "</a>",
      "<text display='none'>Room</text><title>Floor</title>" + box,
      "<style>.w{fill:#333}</style><g style='display:none'><text>Room</text></g>" + box,
      "<g xmlns:i='http://www.inkscape.org/namespaces/inkscape' i:label='a'>" + box +
          "<i:grid/></g>",
  };
  for (const std::string& content : contents) expect_walls(page_of(content), kBox, kAround);
  const std::string dot = "<circle cx='15' cy='10' r='1'/>";
  expect_walls(
      "<s:svg xmlns:s='http://www.w3.org/2000/svg' viewBox='0 0 40 30'><s:rect x='10' y='5' "
      "width='10' height='10'/><s:circle cx='15' cy='10' r='1'/></s:svg>",
      kBox, kAround);
  for (const char* size :
       {"width='400' height='100'", "width='50%' preserveAspectRatio='xMinYMin slice'",
        "style='width:100%;height:auto'", "style='width:20px;height:300px'"})
    expect_walls(page_of(box + dot, size), kBox, kAround);
}

TEST_F(OtherPeoplesDrawings, ShapesAreWhereEveryProgramShowsThem) {
  for (const Drawn& one : std::vector<Drawn>{
           {"<circle cx='15' cy='10' r='5'/>",
            {{15, 10}, {15, 5.1}, {18.4, 13.4}},
            {{18.7, 13.7}, {15, 4.9}}},
           {"<ellipse cx='15' cy='10' rx='8' ry='4'/>",
            {{7.1, 10}, {15, 13.9}},
            {{6.9, 10}, {15, 14.1}, {21, 13}}},
           {"<path d='M10 10A5 5 0 0120 10z'/>", {{15, 5.1}, {11, 9}}, {{15, 10.1}, {10.5, 6}}},
           {"<path d='M10 10C10 0 20 0 20 10z'/>", {{15, 2.6}}, {{15, 2.4}, {15, 10.1}}},
           {"<rect x='10' y='5' width='10' height='10' rx='4'/>",
            {{15, 5.1}, {10.1, 10}, {11.3, 6.3}},
            {{10.5, 5.5}, {19.5, 14.5}}},
           // Rooms, and a door that is painted over a wall.
           {"<path fill='none' stroke='#000' d='M10 20V5H30V25H10'/>",
            {{10, 15}, {20, 5.4}, {29.6, 24.6}},
            {{20, 15}, {5, 15}, {10.6, 5.6}}},
           {"<style>.w{fill:none;stroke:#000;stroke-width:1}</style>"
            "<path class='w' d='M10 20V5H30V25H10'/>",
            {{10, 15}, {20, 5.4}},
            {{20, 15}, {5, 15}}},
           {"<rect x='5' y='5' width='30' height='20'/>"
            "<rect x='6' y='6' width='28' height='18' fill='#fff'/>"
            "<path stroke='white' stroke-width='2' d='M5.5 10v4'/>",
            {{5.5, 8}, {20, 5.5}, {34.5, 20}},
            {{5.5, 12}, {20, 15}}},
           {"<path stroke='black' stroke-dasharray='4 4' d='M10 10h16'/>",
            {{12, 10}, {20, 10}},
            {{16, 10}, {24, 10}}},
           {"<path d='M10 5L30 25V5L10 25z'/>", {{11, 15}, {29, 15}}, {{20, 10}, {20, 20}}},
           {"<g transform='rotate(90 20 15)'><rect x='10' y='14' width='20' height='2' "
            "rx='.1'/></g>",
            {{20, 5.2}, {19.1, 24}},
            {{18.9, 15}, {11, 15}}},
           {"<marker id='m' markerWidth='6' markerHeight='6' refX='3' refY='3'>"
            "<rect width='6' height='6'/></marker>"
            "<path d='M10 10h10' stroke='#000' marker-end='url(#m)'/>",
            {{20, 12.5}, {22.5, 10}},
            {{20, 13.3}, {10, 12}}},
       })
    expect_walls(page_of(one.content), one.solid, one.free);
  expect_walls(page_of("<rect x='10' y='5' width='10' height='10' fill='white'/>"), kBox, kAround,
               "solid_white: true");
  expect_walls(page_of("<circle cx='15' cy='10' r='9' fill='white'/>"), kBox, {{30, 20}},
               "solid_white: true");
}

// However thin, on a page with and without paper; the circle has the drawing painted.
TEST_F(OtherPeoplesDrawings, ThinWallsAreClosed) {
  const std::string circle = R"(<circle cx="35" cy="25" r="1"/>)";
  const std::string paper = R"(<rect width="40" height="30" fill="#fff"/>)";
  Places solid, point, straight;
  for (int i = 0; i <= 997; ++i) {
    const double at = 5.01 + 19.98 * i / 997.0;
    solid.emplace_back(at, 10.00013);
    solid.emplace_back(10.00013, at);
    straight.insert(straight.end(), solid.end() - 2, solid.end());
    solid.emplace_back(at, at + 1);
    if (i < 300) point.push_back(solid.back());
  }
  const std::string wedge = "<path d='M4.98 6L25 26v.04z'/>";
  const auto hairs_of = [&](const std::string& edges, const std::string& more) {
    return page_of("<g shape-rendering='" + edges + "'>" + more + circle +
                   "<rect x='5' y='10' width='20' height='.01'/>"
                   "<rect y='5' x='10' height='20' width='.01'/></g>");
  };
  Places filled = solid;
  std::erase_if(filled, [&](const Eigen::Vector2d& at) {
    return std::ranges::find(point, at) != point.end();
  });
  for (const std::string& page : {std::string(), paper}) {
    expect_walls(hairs_of("auto", page.empty() ? wedge : page), page.empty() ? filled : straight,
                 {{20, 5}});
    const std::string lines = " d='M5 10.00013h20M10.00013 5v20M5 6l20 20'/>";
    expect_walls(page_of(page + "<path fill='none' stroke='#f00' stroke-width='.01'" + lines),
                 solid, {{15, 11}, {15, 20}});
    expect_walls(page_of("<style>.w{fill:none;stroke:#000;stroke-width:.01}</style>" + page +
                         "<path transform='translate(5)' class='w' "
                         "d='M0 10.00013h20M5.00013 5v20M0 6l20 20'/>"),
                 solid, {{15, 11}});
  }
  expect_walls(hairs_of("crispEdges", wedge), filled, {{20, 5}});
  // Its point is as bright as paper.
  expect_refused(hairs_of("auto", paper + wedge), "m that is too thin and bright to be solid");
  // These may lie between the rows in which a painting takes samples.
  std::string hairs;
  Places of_hairs;
  for (const double at : {5.003, 8.011, 11.017, 14.007, 17.013, 20.005}) {
    const std::string place = std::to_string(at);
    hairs += "<ellipse cx='20' rx='9' ry='.0001' cy='" + place + "'/>";
    of_hairs.emplace_back(20, at);
  }
  expect_walls(page_of(hairs), of_hairs, {{35, 15}});
  expect_walls(page_of("<g transform='matrix(0 1 1 0 0 0)'>" + hairs + "</g>"), {{5.003, 20}},
               {{5.5, 20}});
  expect_refused(page_of(circle + R"(<rect x="5" y="10" width="20" height="0.0001"/>)"),
                 "line 2: <rect>: is too thin to be painted");
  for (const char* thin : {
           "<path d='M5 6l20 20' stroke='#000' stroke-width='0'/>",
           "<path d='M5 6l20 20' stroke='#000' stroke-width='0.002'/>",
           "<path transform='scale(1e-5)' d='M5 6l20 20' stroke='#000'/>",
           "<style>.w{stroke-width:0}</style><path style='stroke:red' class='w' d='M5 6l20 20'/>",
           "<style>.w{stroke:red;stroke-width:1e-6}</style><path class='w' d='M5 6l20 20'/>",
       })
    expect_refused(page_of(thin), "line 2: <path>: has a stroke too thin to be painted");
  expect_refused(page_of("<path d='M5 6l20 20' vector-effect='non-scaling-stroke'/>"),
                 "has a vector-effect, which is not painted");
}

// In a painting, a thin line is brighter than its colour; white may lose it.
TEST_F(OtherPeoplesDrawings, BrightWallsAreSolidOrRefused) {
  const std::string paper = R"(<rect width="40" height="30" fill="#fff"/>)";
  const std::string circle = R"(<circle cx="35" cy="25" r="1"/>)";
  const auto line = [&](const std::string& colour, const std::string& width) {
    return "<path d='M5 10h20' stroke='" + colour + "' stroke-width='" + width + "'/>" + circle;
  };
  const Places on = {{6, 10}, {24, 10}};
  for (const char* colour : {"yellow", "#eee", "#00ffff", "rgb(240,240,240)"}) {
    expect_walls(page_of(paper + line(colour, ".3")), on, {{15, 12}});
    expect_walls(page_of(line(colour, ".02")), on, {{15, 12}});
  }
  expect_refused(page_of(paper + line("yellow", ".02")),
                 "shows something at x 5.01, y 19.99 m that is too thin and bright to be solid");
  expect_refused(page_of("<style>.w{stroke:#eee;stroke-width:.02}</style>" + paper +
                         "<path class='w' d='M5 10h20'/>" + circle),
                 "too thin and bright");
  expect_refused(page_of(paper +
                         "<g opacity='.04'><rect x='5' y='10' width='20' height='.02' "
                         "rx='.001'/></g>" +
                         circle),
                 "too thin and bright");
  expect_refused(page_of(paper + "<ellipse cx='20' cy='15.003' rx='9' ry='.0003'/>" + circle),
                 "too thin and bright");
  // On paper that is not quite white, and beside a wall.
  const std::string cream = R"(<rect width="40" height="30" fill="#fffdd0"/>)";
  expect_refused(page_of(cream + line("yellow", ".02")), "too thin and bright");
  expect_refused(page_of(paper + line("yellow", ".02") +
                         "<path d='M5 10.06h20' stroke='#000' stroke-width='.02'/>"),
                 "too thin and bright");
  expect_walls(page_of(cream + "<path d='M5 5h9L5 8z' fill='#fffbb0'/>" + circle), {{35, 25}},
               {{8, 6}});
  // Areas that are nearly white are no walls, nor are the edges of anything.
  expect_walls(page_of("<rect width='40' height='30' fill='ivory'/>" + circle), {{35, 25}},
               {{15, 10}});
  expect_walls(page_of(paper + "<path d='M5 5l8 .5-8 .5z' fill='#222'/>" + circle), {{6, 5.5}},
               {{15, 10}});
}

TEST_F(OtherPeoplesDrawings, SymbolsAreCutAtTheirEdges) {
  const std::string symbol =
      "<symbol id='r' viewBox='0 0 10 10'><rect x='-5' width='30' height='10'/></symbol>";
  for (const std::string style : {"", "style='overflow:visible'"})
    expect_walls(
        page_of(symbol + "<use href='#r' " + style + " x='10' y='5' width='10' height='10'/>"),
        kBox, kAround);
}

TEST_F(OtherPeoplesDrawings, AllProblemsOfADrawingAreNamedAtOnce) {
  const auto all_of = [&](const std::string& svg) {
    const Loaded loaded = walls_of(page_of(svg), "");
    return loaded ? std::string() : joined(loaded.error());
  };
  const std::string three = all_of(
      "<text>a</text>\n<g widht='3'><image/></g>\n<path d='M1 1 X2'/><rect fill='url(#a)'/>");
  for (const char* one :
       {"line 2: <text>: is not read", "line 3: <g>: has the attribute widht, which is none of SVG",
        "line 3: <image>: is not read", "line 4: <path>: d has the unknown command X",
        "line 4: <rect>: fill refers to #a, which is not there"})
    EXPECT_TRUE(has(three, one));
  std::string texts;
  for (int i = 0; i < 30; ++i) texts += "<text>a</text>\n";
  const std::string many = all_of(texts);
  EXPECT_TRUE(has(many, "line 21: <text>"));
  EXPECT_FALSE(has(many, "line 22: <text>"));
  EXPECT_TRUE(has(many, "has more problems than these 20 (repair these first)"));
}

TEST_F(OtherPeoplesDrawings, DrawingsThatCouldLoseAWallAreRefused) {
  const std::string box = R"(<rect x="10" y="5" width="10" height="10"/>)";
  for (const auto& [content, words] : std::vector<std::pair<std::string, std::string>>{
           {"<text>Room</text>", "line 2: <text>: is not read (delete it, hide it"},
           {"<style>g{display:inline}</style><text display=\"none\"/>", "<text>: is not read"},
           {"<image href=\"a.png\"/>", "line 2: <image>: is not read"},
           {"<foreignObject/>", "line 2: <foreignObject>: is not read"},
           {"<script/>", "line 2: <script>: is not read"},
           {"<wall/>", "line 2: <wall>: is no element that is painted"},
           {"<g clip-path=\"url(#c)\"><rect/></g>",
            "line 2: <g>: clip-path refers to #c, which is not there"},
           {"<use href=\"b.svg#a\"/>", "line 2: <use>: refers to another file"},
           {"<g id=\"a\"><use href=\"#a\"/></g>", "line 2: <use>: refers to itself through #a"},
           {"<path d=\"M1 1 L2 2 Q\"/>", "line 2: <path>: d has no finite number"},
           {"<path d=\"M1 1 X2 2\"/>", "line 2: <path>: d has the unknown command X"},
           {"<path d=\"M1 1A5 5 0 2 0 9 9\"/>", "d has an arc whose flags are not 0 or 1"},
           {"<circle r=\"3furlongs\"/>", "line 2: <circle>: r is in furlongs"},
           {"<rect filter=\"url(#f)\"/>", "line 2: <rect>: has a filter"},
           {"<rect style=\"fill\"/>", "line 2: <rect>: has no property at \"fill\""},
           {"<rect style=\"fil: red\"/>", "<rect>: has the property fil, which is not painted"},
           {"<rect style=\"fill: var(--wall)\"/>", "fill has the function \"var\""},
           {"<style>@media print { rect { fill: none } }</style>", "line 2: <style>: has the rule"},
           {"<style>rect:hover { fill: none }</style>", "has the selector \"rect:hover\""},
           {"<style media=\"print\"/>", "is no style sheet for every display"},
           {"<g systemLanguage=\"de\"/>", "makes it show on some machines only"},
           {"<pattern id=\"p\"/><rect fill=\"url(#p)\"/>",
            "<rect>: fill refers to #p, which is a pattern and is not painted"},
           {"<g onclick=\"a()\"/>", "onclick runs a script"},
           {"<path stroke=\"blak\"/>", "stroke is \"blak\", which is not painted"},
           {"<g fill=\"none\"><rect fill=\"initial\"/></g>", "fill is \"initial\""},
           {"<path stroke-width=\"1,5\"/>", "stroke-width is in ,5, which is not read"},
           {"<path stroke=\"rgb(51,51)\"/>", "stroke is \"rgb(51,51)\", which is not painted"},
           {"<path stroke=\"rgb(20%,20,20)\"/>", "stroke is \"rgb(20%,20,20)\""},
           {"<path fill=\"hsl(0,0,20)\"/>", "fill is \"hsl(0,0,20)\""},
           {"<rect style=\"width:1O;height:10\"/>", "width is in O, which is not read"},
           {"<style>circle{r:5foo}</style>", "r is in foo, which is not read"},
           {"<linearGradient id=\"g\"><title/></linearGradient>",
            "has no stops, and paints nothing"},
           {"<g opacity=\"half\"/>", "opacity is \"half\""},
           {"<g fill-rule=\"even\"/>", "fill-rule is \"even\""},
           {"<g color=\"none\"/>", "color is \"none\""},
           {"<rect style=\"STROKE:black\"/>", "has the property STROKE, which is not painted"},
           {"<rect widht=\"9\"/>", "has the attribute widht, which is none of SVG"},
           {"<rect x=\"1em\"/>", "x is in em, which is not read"},
           {"<rect id=\"r\" fill=\"url(#r)\"/>", "#r, which is a <rect> and is not painted"},
           {"<clipPath id=\"r\"/><use href=\"#r\"/>", "href refers to #r, which is a <clipPath>"},
           {"<svg id=\"r\"/><use href=\"#r\" width=\"9\"/>", "#r, which is a <svg>"},
           {"<linearGradient id=\"g\"/>", "<linearGradient>: has no stops, and paints nothing"},
           {"<symbol overflow=\"visible\"/>", "is a symbol that overflows"},
           {"<style>g{overflow:visible}</style><symbol/>", "lets symbols overflow"},
           {"<g style=\"background:#000\"/>", "background is \"#000\", and backgrounds"},
           {"<rect width=\"40\" height=\"30\" rx=\"1\"/>", "more than 90 % of it is solid"},
           {"<circle cx=\"90\" cy=\"5\" r=\"1\"/>", "shows nothing that is solid"},
       })
    expect_refused(
        page_of(content + (words.find('%') == words.npos && content[1] != 'c' ? box : "")), words);
  expect_refused("<!DOCTYPE svg [<!ENTITY a \"b\">]>" + page_of(box), "declares entities");
  expect_refused("<?xml-stylesheet href=\"a.css\"?>" + page_of(box),
                 "has its style in another file");
  expect_refused(std::string("\xff\xfe<\0s\0", 6) + page_of(box), "is in UTF-16, not UTF-8");
}

}  // namespace
}  // namespace ergocast
