#include "garment/pattern/check_pattern.h"

#include <gtest/gtest.h>

#include "garment/pattern/check_panel.h"
#include "tests/garment/pattern/panels.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace garment;

namespace {

std::string panel_complaint(const Panel& panel)
{
    return refusal([&] { require_cuttable(panel, "p.json"); });
}

std::string pattern_complaint(const std::vector<Panel>& panels, const std::vector<Seam>& seams)
{
    Pattern pattern;
    pattern.source = "p.json";
    pattern.panels = panels;
    pattern.seams = seams;
    return refusal([&] { require_sewable(pattern); });
}

TEST(CheckPanel, AcceptsWhatCanBeCut)
{
    EXPECT_EQ(panel_complaint(rectangle("r", 0.3, 0.5)), "");
    Panel lens = polygon("lens", {{0.0, 0.0}, {0.3, 0.0}});
    lens.edges[0].curve = CircularArc{0.2, false, true};
    EXPECT_EQ(panel_complaint(lens), "");
    // A dart, and a corner in the middle of a straight line.
    EXPECT_EQ(panel_complaint(polygon("dart", {{0.0, 0.0},
                                               {0.1, 0.0},
                                               {0.15, 0.3},
                                               {0.2, 0.0},
                                               {0.25, 0.0},
                                               {0.3, 0.0},
                                               {0.3, 0.5},
                                               {0.0, 0.5}})),
              "");
}

TEST(CheckPanel, RefusesOpenLoops)
{
    Panel open = rectangle("front", 0.3, 0.5);
    open.edges[2].end = 2;
    EXPECT_EQ(panel_complaint(open),
              "p.json: panel \"front\", edge 2: ends at vertex 2, but edge 3 starts at "
              "vertex 3; the edges of a panel must form one closed loop");
    Panel stray = rectangle("front", 0.3, 0.5);
    stray.corners.emplace_back(9.0, 9.0);
    EXPECT_EQ(panel_complaint(stray), "p.json: panel \"front\": its vertex 4 is on no edge; remove it");
    Panel traced = polygon("traced", std::vector<Vec2>(1001, Vec2(0.1, 0.1)));
    EXPECT_EQ(refusal([&] { require_cuttable(traced, "p.json"); }),
              "p.json: panel \"traced\": has 1001 edges, at most 1000 may be; write curves in place of short "
              "lines");
    Panel single = rectangle("front", 0.3, 0.5);
    single.edges.resize(1);
    EXPECT_EQ(panel_complaint(single),
              "p.json: panel \"front\": has 1 edge; a loop needs three, or two of which one is curved");
}

TEST(CheckPanel, RefusesLoopsThatMeetThemselves)
{
    const std::string crossed =
        panel_complaint(polygon("bow", {{0.0, 0.0}, {0.4, 0.4}, {0.4, 0.0}, {0.0, 0.4}}));
    EXPECT_EQ(crossed,
              "p.json: panel \"bow\", edge 0: crosses or touches edge 2 near (0.2, 0.2) m; move vertices "
              "or control points apart");
    // A corner that lies on another edge.
    const std::string touched =
        panel_complaint(polygon("nip", {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.4}, {0.2, 0.0}, {0.0, 0.4}}));
    EXPECT_NE(touched.find("edge 0: crosses or touches edge 2"), std::string::npos) << touched;
    // A hem that curves through the side.
    Panel curved = rectangle("curved", 0.3, 0.5);
    curved.edges[0].curve = Bezier{{{0.15, 1.2}}};
    EXPECT_NE(panel_complaint(curved).find("edge 0: crosses or touches edge 2"), std::string::npos)
        << panel_complaint(curved);
    Panel loop = rectangle("loop", 0.3, 0.5);
    loop.edges[0].curve = Bezier{{{1.0, -0.5}, {-0.7, -0.5}}};
    EXPECT_NE(panel_complaint(loop).find("edge 0: crosses itself"), std::string::npos)
        << panel_complaint(loop);
    // A corner that the loop visits twice.
    Panel pinched = polygon("pinch", {{0.0, 0.0}, {0.2, 0.2}, {0.4, 0.0}, {0.4, 0.4}, {0.0, 0.4}});
    pinched.edges = {{0, 1, Bezier{}, {}}, {1, 2, Bezier{}, {}}, {2, 3, Bezier{}, {}},
                     {3, 1, Bezier{}, {}}, {1, 4, Bezier{}, {}}, {4, 0, Bezier{}, {}}};
    EXPECT_NE(panel_complaint(pinched).find("edge 4: starts at vertex 1, where the loop was before"),
              std::string::npos)
        << panel_complaint(pinched);
    // An edge that runs back along the one before it.
    const std::string back =
        panel_complaint(polygon("back", {{0.0, 0.0}, {0.4, 0.0}, {0.2, 0.0}, {0.2, 0.4}}));
    EXPECT_NE(back.find("crosses or touches edge"), std::string::npos) << back;
}

TEST(CheckPanel, RefusesWhatHasNoLengthOrArea)
{
    EXPECT_EQ(
        panel_complaint(polygon("p", {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.00005}, {0.0, 0.4}})),
        "p.json: panel \"p\", edge 1: its ends are 5e-05 m apart; leave it out, or move a vertex by 0.1 mm "
        "at least");
    const std::string thin = panel_complaint(rectangle("thin", 1.0, 0.0002));
    EXPECT_EQ(
        thin,
        "p.json: panel \"thin\": has an area of 0.0002 m^2 in a loop of 2 m; it is too thin to cut out");
    Panel arc = rectangle("arc", 0.3, 0.5);
    arc.edges[1].curve = CircularArc{0.2, false, true};
    EXPECT_EQ(panel_complaint(arc),
              "p.json: panel \"arc\", edge 1: an arc of radius 0.2 m cannot join ends that "
              "are 0.5 m apart; use at least half that distance");
}

const Panel kFront = rectangle("front", 0.4, 0.6);
const Panel kBack = rectangle("back", 0.4, 0.6);

TEST(CheckPattern, AcceptsATube)
{
    EXPECT_EQ(pattern_complaint({kFront, kBack},
                                {seam(forward(0, 1), backward(1, 3)), seam(forward(0, 3), backward(1, 1))}),
              "");
}

TEST(CheckPattern, RefusesWrongUnits)
{
    const std::string remedy = ": properties.units_in_meter of panel JSON, or \"unit\" in a garment file";
    EXPECT_EQ(
        pattern_complaint({rectangle("front", 40.0, 60.0), rectangle("cuff", 8.0, 20.0)}, {}),
        "p.json: panel \"front\": is the largest and 60 m long, a house; the unit is wrong, with 100 times "
        "as many units in a metre it would have 0.6 m" +
            remedy);
    EXPECT_EQ(
        pattern_complaint({rectangle("front", 0.004, 0.006)}, {}),
        "p.json: panel \"front\": is the largest and 0.006 m long, less than a hand; the unit is wrong, with "
        "0.01 times as many units in a metre it would have 0.6 m" +
            remedy);
    // Small parts of a garment are no mistake.
    EXPECT_EQ(pattern_complaint({kFront, rectangle("tab", 0.02, 0.04)}, {}), "");
    EXPECT_EQ(pattern_complaint({}, {}), "p.json: has no panel; a garment needs one at least");
}

TEST(CheckPattern, RefusesAnEdgeInTwoSeams)
{
    Seam first = seam(forward(0, 1), backward(1, 3));
    first.name = "first";
    EXPECT_EQ(pattern_complaint({kFront, kBack}, {first, seam(forward(0, 1), backward(1, 1))}),
              "p.json: seam: front edge 1 is in first too; an edge is sewn once, or each part of it once");
    EXPECT_EQ(pattern_complaint({kFront, kBack}, {seam(forward(0, 1), backward(0, 1))}),
              "p.json: seam: front edge 1 is in it twice; an edge is sewn once, or each part of it once");
    // Parts may meet but not overlap.
    const auto halves = [&](double until) {
        const Panel half = rectangle("half", 0.4, 0.3);
        return pattern_complaint({kFront, half, half}, {seam({0, 1, 0.0, until}, backward(1, 1)),
                                                        seam({0, 1, 0.5, 1.0}, backward(2, 1))});
    };
    EXPECT_EQ(halves(0.5), "");
    EXPECT_EQ(halves(0.51),
              "p.json: seam: front edge 1[0.5:1] is in seam too; an edge is sewn once, or each part "
              "of it once");
}

TEST(CheckPattern, RefusesLengthsThatCannotBeGathered)
{
    const Panel ruffle = rectangle("ruffle", 1.2, 0.2);
    EXPECT_EQ(pattern_complaint({kFront, ruffle}, {seam(forward(0, 0), backward(1, 0))}),
              ""); // 3 times
    EXPECT_EQ(
        pattern_complaint({kFront, rectangle("wrong", 2.0, 0.2)}, {seam(forward(0, 0), backward(1, 0))}),
        "p.json: seam: front edge 0 is 0.4 m long, but wrong edge 0 2 m; at most 4 times as long can be "
        "gathered, sew other edges or parts of them");
}

TEST(CheckPattern, RefusesTwoLabelsOverASeam)
{
    Panel front = kFront;
    Panel back = kBack;
    front.edges[2].label = "left_collar";
    back.edges[2].label = "lower_interface";
    EXPECT_EQ(
        pattern_complaint({front, back}, {seam(forward(0, 2), backward(1, 2))}),
        "p.json: seam: front edge 2 is labelled \"left_collar\", but back edge 2 \"lower_interface\"; edges "
        "that are sewn become one, give them one label");
    back.edges[2].label = "left_collar";
    EXPECT_EQ(pattern_complaint({front, back}, {seam(forward(0, 2), backward(1, 2))}), "");
    back.edges[2].label = "";
    EXPECT_EQ(pattern_complaint({front, back}, {seam(forward(0, 2), backward(1, 2))}), "");
}

/// A waistband goes round two panels, which are sewn at their sides.
TEST(CheckPattern, FollowsChainsThroughOtherSeams)
{
    const Panel band = rectangle("band", 0.8, 0.1);
    Seam waist;
    waist.name = "waist";
    waist.a = {forward(2, 0)};
    waist.b = {backward(0, 2), backward(1, 2)};
    // The end of the first, the front's right upper corner, is sewn to the back's left upper corner.
    const Seam side = seam(forward(0, 1), backward(1, 3));
    EXPECT_EQ(pattern_complaint({kFront, kBack, band}, {waist, side}), "");
    EXPECT_EQ(pattern_complaint({kFront, kBack, band}, {waist}),
              "p.json: waist: back edge 2 does not continue front edge 2; list edges in their order along "
              "the seam, "
              "each from the end of the one before (EDGE[1:0] runs backwards), or make two seams");
    // Around a corner of one panel.
    Seam corner;
    corner.name = "corner";
    corner.a = {forward(0, 0), forward(0, 1)};
    corner.b = {backward(1, 1), backward(1, 0)};
    EXPECT_EQ(pattern_complaint({kFront, kBack}, {corner}), "");
    std::swap(corner.b[0], corner.b[1]);
    EXPECT_NE(pattern_complaint({kFront, kBack}, {corner}).find("back edge 1 does not continue back edge 0"),
              std::string::npos);
}

} // namespace
} // namespace toile::test
