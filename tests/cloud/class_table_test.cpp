#include "pcednet/cloud/class_table.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace pcednet {
namespace {

TEST(ClassTable, OfEdgesIsThatOfTheEdgeClasses) {
  const ClassTable& edges = edge_classes();
  ASSERT_EQ(edges.size(), kEdgeClasses.size());
  EXPECT_EQ(edges[kSharpEdge].name, "sharp-edge");
  EXPECT_EQ(edges[kSharpEdge].colour, kEdgeClasses[kSharpEdge].colour);
  EXPECT_TRUE(has_edges(edges));
  EXPECT_FALSE(has_own_classes(edges));
}

TEST(ClassTable, IsReadAsAUserWritesIt) {
  const ClassTable own = parse_classes(" ground, wall of brick =#0A0b0c,pipe\n");
  ASSERT_EQ(own.size(), 3u);
  EXPECT_EQ(own[1], (PointClass{"wall of brick", {10, 11, 12}}));
  EXPECT_EQ(own[2].name, "pipe");
  EXPECT_EQ(own[2].colour, usual_colour(2));
  EXPECT_FALSE(has_edges(own));
  EXPECT_EQ(names_of(own), "ground, wall of brick, pipe");

  const ClassTable more = parse_classes("edges\npipe\r\n");
  ASSERT_EQ(more.size(), 5u);
  EXPECT_TRUE(has_edges(more));
  EXPECT_TRUE(has_own_classes(more));
  EXPECT_EQ(names_of(more), "edges, pipe");
}

TEST(ClassTable, GivesNoColourTwice) {
  const ClassTable own = parse_classes("x=" + text_of(usual_colour(1)) + ", pipe, wall");
  EXPECT_EQ(own[1].colour, usual_colour(2));
  EXPECT_EQ(own[2].colour, usual_colour(3));
  const ClassTable last = parse_classes("pipe, x=" + text_of(usual_colour(0)));
  EXPECT_EQ(last[0].colour, usual_colour(1));
}

TEST(ClassTable, RefusesWhatIsNone) {
  for (const char* wrong :
       {"", "ground", "a,b,a", "a,,b", "a,b=red", "a,b=#12345", "edges,a,b,c,d,e",
        "a,b,c,d,e,f,g,h,i", "a,b\tc", "a,\xff", "a,\xe0\x80\x80", "a,\xed\xa0\x80",
        "a,\xf0\x80\x80\x80", "a,\xf4\x90\x80\x80", "a,=#123456",
        "a,bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb"}) {
    EXPECT_ERROR(ErrorKind::kUsage, parse_classes(wrong)) << wrong;
  }
  for (const char* name :
       {"\xe0\xa0\x80", "\xed\x9f\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_EQ(parse_classes(std::string("a,") + name)[1].name, name);
  }
}

TEST(ClassTable, GoesThroughTheCommentsOfACloud) {
  const ClassTable own = parse_classes("Straße,wall 2=#ff0000,edges");
  std::vector<std::string> comments = {"made by hand", "pcednet classes 0 non-edge"};
  for (const std::string& line : lines_of(own, kClassComment)) comments.push_back(line);
  EXPECT_EQ(comments.back(), "pcednet class 2 #f28e2b edges");
  EXPECT_EQ(classes_of(comments), own);
  EXPECT_EQ(classes_of({"made by hand"}), edge_classes());

  comments.pop_back();
  comments.push_back("pcednet class 7 #f28e2b pipe");  // a number is left out
  EXPECT_EQ(classes_of(comments), edge_classes());
  comments.back() = "pcednet class 2 #f28e2 pipe";
  EXPECT_FALSE(table_of(comments, kClassComment).has_value());
}

TEST(ClassTable, SpellsColours) {
  EXPECT_EQ(text_of(Rgb{0, 82, 165}), "#0052a5");
  EXPECT_EQ(colour_of("#0052A5"), (Rgb{0, 82, 165}));
  for (const char* wrong : {"0052a5", "#0052a", "#0052a5f", "#00 2a5", "#+052a5"}) {
    EXPECT_FALSE(colour_of(wrong).has_value()) << wrong;
  }
}

}  // namespace
}  // namespace pcednet
