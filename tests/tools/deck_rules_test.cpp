// SPDX-License-Identifier: BSD-3-Clause
// Decks are read without silent changes: parameters, fields, lines, positions, repeated definitions.
#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "case/case_file.hpp"
#include "program/deck_case.hpp"

using namespace kacanov;

namespace {

/// A deck with every supported keyword.
const std::string everything =
    "*HEADING\nA cube\n*PART, NAME=P\n*NODE, "
    "NSET=NALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n"
    "7,1,1,1\n8,0,1,1\n*ELEMENT, TYPE=C3D8, ELSET=E\n1,1,2,3,4,5,6,7,8\n*END PART\n*ASSEMBLY, NAME=A\n"
    "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*NSET, NSET=BOT, GENERATE, INSTANCE=I\n1,4,1\n*NSET, "
    "NSET=TOP, "
    "INTERNAL\n5,6,7,8\n*NSET, NSET=AROUND, ELSET=I.E\n*ELSET, ELSET=F\nI.E\n*SURFACE, NAME=S, "
    "TYPE=ELEMENT\nF,S2\n"
    "*SURFACE, NAME=N, TYPE=NODE\nTOP,1.\n*END ASSEMBLY\n*MATERIAL, NAME=M\n*ELASTIC, "
    "TYPE=ISO\n1000,0.25,20.\n"
    "*PLASTIC, HARDENING=ISOTROPIC\n200,0\n300,0.1,0.\n*DENSITY\n1e-3\n*EXPANSION, ZERO=2.D1\n1e-5\n*SOLID "
    "SECTION, "
    "ELSET=I.E, MATERIAL=M\n1.\n*BOUNDARY\nBOT,ENCASTRE\n*INITIAL CONDITIONS, "
    "TYPE=TEMPERATURE\nI.NALL,20.\n*STEP, "
    "NAME=S1, INC=10, NLGEOM=NO\nits title\n*STATIC\n0.1,1.\n*BOUNDARY, OP=MOD, "
    "TYPE=DISPLACEMENT\nTOP,1,1,0.\n*CLOAD, "
    "OP=NEW\nTOP,3,-2.5\n*DLOAD\nE,P2,1.\nE,GRAV,9.81,0,0,-1\n*DSLOAD\nS,P,1.\n*TEMPERATURE\nI.NALL,30.\n*"
    "NODE FILE\n"
    "U\n*END STEP\n";

const std::string nodes =
    "*NODE,NSET=NALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";
const std::string sets = "*NSET,NSET=BOT\n1,2,3,4\n*NSET,NSET=TOP\n5,6,7,8\n";
const std::string mesh = nodes + "*ELEMENT,TYPE=C3D8,ELSET=E\n1,1,2,3,4,5,6,7,8\n" + sets;  // lines 1 to 15
const std::string steel = "*MATERIAL,NAME=M\n*ELASTIC\n1000,0.25\n";
const std::string section = "*SOLID SECTION,ELSET=E,MATERIAL=M\n";
const std::string model = mesh + steel + section;  // lines 1 to 19
const std::string held = "*BOUNDARY\nBOT,1,3\n", load = "*CLOAD\nTOP,3,-2.5\n";
const std::string begin = "*STEP\n*STATIC\n", end = "*END STEP\n";
const std::string plain = model + begin + held + load + end;

DeckCase made(const std::string& deck, bool leave_out = false) {
  return case_of(read_deck("a.inp", deck), leave_out);
}

std::string refusal(const std::string& deck) {
  try {
    made(deck);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

std::string document(const std::string& deck) { return made(deck).document.dump(); }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Returns the text with `more` appended to line `which`, counted from 0.
std::string with(const std::vector<std::string>& lines, std::size_t which, const std::string& more) {
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) text += lines[i] + (i == which ? more : "") + "\n";
  return text;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a parameter that is not known is refused by line, whatever the keyword") {
  REQUIRE_NOTHROW(made(everything));
  const std::vector<std::string> lines = lines_of(everything);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i][0] != '*' || lines[i] == "*NODE FILE") continue;
    for (const char* parameter : {"FOO=3", "FOO", "AMPLITUDE=A", "INPUT=b.inp"}) {
      const std::string message = refusal(with(lines, i, std::string(", ") + parameter));
      CAPTURE(lines[i]);
      CAPTURE(message);
      CHECK(message.starts_with("a.inp: line " + std::to_string(i + 1) + ": "));
      CHECK(contains(message, parameter));
    }
    const std::string alone = refusal(with(lines, i, ",\nFOO=3"));
    CHECK(contains(alone, "FOO=3"));
  }
}

TEST_CASE("a field too many is refused by line, whatever the keyword") {
  const std::vector<std::string> lines = lines_of(everything);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i][0] == '*' || lines[i] == "A cube" || lines[i] == "its title" || lines[i] == "U") continue;
    CAPTURE(lines[i]);
    for (const char* more : {",,,,,,,3", ",3,3,3,3,3,3,3", ",,,,,,,x"}) {
      // More numbers in a set are further members; for a surface of nodes only the first field may be
      // followed by others.
      if (lines[i] == "5,6,7,8" && more[7] != 'x') continue;
      const std::string message = refusal(with(lines, i, more));
      CAPTURE(message);
      CHECK(message.starts_with("a.inp: line " + std::to_string(i + 1) + ": "));
    }
    CHECK(document(with(lines, i, ",")) == document(everything));  // a trailing comma, which adds no field
  }
  CHECK(refusal(model + begin + held + "*CLOAD\nTOP,3,3,-2.5\n" + end) ==
        "a.inp: line 25: expected no more than a node or set, a degree of freedom and a force, got \"-2.5\" "
        "as well");
}

TEST_CASE("a line of data too many is refused by line where a keyword has none or one") {
  const std::vector<std::string> lines = lines_of(everything);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string keyword = lines[i].substr(0, lines[i].find(','));
    for (const char* none : {"*PART", "*END PART", "*ASSEMBLY", "*INSTANCE", "*END INSTANCE", "*END ASSEMBLY",
                             "*MATERIAL", "*END STEP"})
      if (keyword == none) {
        const std::string message = refusal(with(lines, i, "\n1,2"));
        CAPTURE(message);
        CHECK(message.starts_with("a.inp: line " + std::to_string(i + 2) + ": "));
      }
  }
  for (const auto& [one, more] :
       {std::pair("*ELASTIC\n", "1000,0.25\n"), std::pair("*DENSITY\n", "1\n"),
        std::pair("*STATIC\n", "1,1\n"), std::pair("*SOLID SECTION,ELSET=E,MATERIAL=M\n", "1\n")}) {
    std::string deck = model + begin + held + load + end;
    if (std::string(one) == "*DENSITY\n") deck.insert(deck.find("*SOLID"), one);
    deck.insert(deck.find(one) + std::string(one).size(), std::string(more) + more);
    const std::string keyword = one;
    CAPTURE(keyword);
    CHECK(refusal(deck).starts_with("a.inp: line "));
  }
}

TEST_CASE("a keyword continues behind a comma where parameters follow, and not where data follows") {
  const std::string expected = document(plain);
  const auto replaced = [](const std::string& from, const std::string& to) {
    std::string deck = plain;
    deck.replace(deck.find(from), from.size(), to);
    return deck;
  };
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"NSET=TOP\n5,6,7,8", "NSET=TOP,\n5,6\n7,8"},
           {"NSET=TOP\n5,6,7,8", "NSET=UP,\n5,6,7\n*NSET,NSET=TOP,\nUP,8"},
           {"*NSET,NSET=TOP\n5,6,7,8", "*NSET,\nNSET=TOP,\n\n** a comment\n 5,6,\n7,8,"},
           {"NSET=TOP\n5,6,7,8", "NSET=TOP,\nGENERATE\n5,8"},
           {"NSET=TOP\n5,6,7,8", "NSET=TOP,\n  unsorted,\n  generate,\n5,8,1"},
           {"*NODE,NSET=NALL\n", "*NODE,\n nset = NALL,\n"},
           {"*ELASTIC\n", "*ELASTIC,\n"},
           {"*ELASTIC\n", "*ELASTIC,\nTYPE=ISOTROPIC,\n"},
           {"*CLOAD\n", "*CLOAD,\n"},
           {"*BOUNDARY\n", "*BOUNDARY,\n"},
           {"*STATIC\n", "*STATIC,\n"}}) {
    const std::string changed = to;
    CAPTURE(changed);
    CHECK(document(replaced(from, to)) == expected);
  }
  CHECK(refusal(replaced("NSET=TOP\n", "NSET=TOP,\nFOO=3\n")) ==
        "a.inp: line 14: *NSET: FOO=3 is not known here, but NSET, ELSET, GENERATE, INSTANCE, INTERNAL, "
        "UNSORTED");
}

TEST_CASE("loads count in a step, what makes the model before it, and nothing behind *END STEP") {
  const std::vector<std::string> of_a_step{load, "*DLOAD\nE,P2,1.\n", "*DSLOAD\nS,P,1.\n",
                                           "*TEMPERATURE\nNALL,3.\n", "*STATIC\n"},
      of_the_model{steel,
                   section,
                   "*NODE\n9,0,0,2\n",
                   "*ELEMENT,TYPE=C3D8\n2,1,2,3,4,5,6,7,8\n",
                   "*INITIAL CONDITIONS,TYPE=TEMPERATURE\nNALL,3.\n",
                   "*DENSITY\n1\n"},
      of_both{held, "*NSET,NSET=MORE\n1\n", "*ELSET,ELSET=MORE\n1\n", "*SURFACE,NAME=MORE\nE,S1\n"};
  const auto refused = [](const std::string& deck, int line, const char* words) {
    const std::string message = refusal(deck);
    CAPTURE(message);
    CHECK(message.starts_with("a.inp: line " + std::to_string(line) + ": *"));
    CHECK(contains(message, words));
  };
  for (const auto* blocks : {&of_a_step, &of_the_model, &of_both})
    for (const std::string& block : *blocks) refused(plain + block, 27, "behind *END STEP");
  for (const std::string& block : of_a_step)
    refused(model + block + begin + held + end, 20, "outside of a step");
  for (const std::string& block : of_the_model) refused(model + begin + block + end, 22, "in a step");
  for (const std::string& block : of_both) {
    CHECK(refusal(model + block + begin + load + end) == "(accepted)");
    CHECK(refusal(model + begin + block + load + end) == "(accepted)");
  }
  CHECK(refusal(plain + "*NODE FILE\nU\n") == "(accepted)");
  CHECK(made(plain + "*BOUNDARY\n5,1,1,0.5\n", true).document == made(plain).document);
  const DeckCase without = made(model + begin + held + "*CLOAD,FOO=1,BAR\nTOP,3,-2.5\n" + end, true);
  REQUIRE(without.remarks.size() == 2);
  CHECK(contains(without.remarks[0], "LEFT OUT: *CLOAD changes the answer: FOO=1"));
  CHECK(contains(without.remarks[1], "LEFT OUT: *CLOAD changes the answer: BAR"));
  CHECK(
      contains(made(plain + "*BOUNDARY\n5,1,1,0.5\n", true).remarks.back(), "line 27: LEFT OUT: *BOUNDARY"));
}

TEST_CASE("a second definition is refused by line") {
  const std::string more = begin + held + load + end;
  for (const auto& [deck, message] : std::vector<std::pair<std::string, std::string>>{
           {mesh + steel + "*ELASTIC\n2000,0.25\n" + section + more,
            "a.inp: line 19: a second *ELASTIC of the material \"M\": expected one"},
           {mesh + steel + "*PLASTIC\n2,0\n4,0.1\n*PLASTIC\n3,0\n6,0.1\n" + section + more,
            "a.inp: line 22: a second *PLASTIC of the material \"M\": expected one"},
           {mesh + steel + "*DENSITY\n2\n*DENSITY\n2\n" + section + more,
            "a.inp: line 21: a second *DENSITY of the material \"M\": expected one"},
           {mesh + steel + "*EXPANSION\n2\n*EXPANSION\n2\n" + section + more,
            "a.inp: line 21: a second *EXPANSION of the material \"M\": expected one"},
           {mesh + steel + steel + section + more, "a.inp: line 19: a second material \"M\""},
           {mesh + "*SURFACE,NAME=S\nE,S1\n*SURFACE,NAME=s\nE,S2\n" + steel + section + more,
            "a.inp: line 18: a second surface \"S\": expected all of it in one place"},
           {model + begin + "*STATIC\n" + held + load + end, "a.inp: line 22: a second *STATIC in this step"},
           {mesh + "*NSET,NSET=TOP,NSET=A\n5\n" + steel + section + more,
            "a.inp: line 16: *NSET: NSET=A: this parameter is there twice"}})
    CHECK(refusal(deck) == message);
}

TEST_CASE("words that would change the answer are refused by line") {
  const std::string more = begin + held + load + end;
  for (const auto& [deck, message] : std::vector<std::pair<std::string, std::string>>{
           {mesh + steel + "*PLASTIC,RATE=0\n2,0\n" + section + more,
            "a.inp: line 19: *PLASTIC changes the answer: RATE=0 is not known here, but HARDENING"},
           {mesh + steel + "*PLASTIC,SCALESTRESS=2\n2,0\n" + section + more,
            "a.inp: line 19: *PLASTIC changes the answer: SCALESTRESS=2 is not known here, but HARDENING"},
           {mesh + "*NSET,NSET=NONE\n" + steel + section + begin + "*BOUNDARY\nNONE,1,3\n" + end,
            "a.inp: line 24: the set of nodes \"NONE\" is empty"},
           {mesh + "*NSET,NSET=A,GENERATE\n4,1,-1\n" + steel + section + more,
            "a.inp: line 17: expected a range: first, last not below it, and a step of 1 or more"},
           {mesh + "*NSET,NSET=A,GENERATE=NO\n1\n" + steel + section + more,
            "a.inp: line 16: *NSET: GENERATE=NO: GENERATE has no value"},
           {mesh + "*NSET,NSET=A,INSTANCE=Q\n1\n" + steel + section + more,
            "a.inp: line 16: *NSET: there is no instance \"Q\""},
           {mesh + "*NSET,NSET=A,ELSET=E\n1\n" + steel + section + more,
            "a.inp: line 17: expected no lines of data beside ELSET=, whose nodes are the set"},
           {model + begin + held + "*CLOAD\nTOP,3,-2.5x\n" + end,
            "a.inp: line 25: expected a force, got \"-2.5x\""},
           {model + begin + held + "*CLOAD\nTOP,3\n" + end, "a.inp: line 25: expected a force, got nothing"},
           {model + begin + held + "*BOUNDARY,TYPE=VELOCITY\nTOP,3,3,1\n" + end,
            "a.inp: line 24: *BOUNDARY changes the answer: TYPE=VELOCITY is not known here, but "
            "TYPE=DISPLACEMENT"},
           {model + held + begin + "*BOUNDARY,OP=NEW\nTOP,1,3\n" + end,
            "a.inp: line 24: *BOUNDARY changes the answer: OP=NEW removes conditions"},
           {model + begin + held + load, "a.inp: line 20: this *STEP has no *END STEP: is the deck cut off?"},
           {model + "*STEP\n" + held + load + end, "a.inp: line 20: expected *STATIC in this step"},
           {model + "*STEP\n*STATIC,STABILIZE=0.1\n" + held + load + end,
            "a.inp: line 21: *STATIC changes the answer: STAB"},
           {model + begin + held + "1,2\n*END STEP\n1,2\n",
            "a.inp: line 26: *END STEP has no lines of data, got \"1\""},
           {plain + "*END STEP\n", "a.inp: line 27: *END STEP: it ends no *STEP"},
           {"*PART,NAME=P\n" + mesh + "*ASSEMBLY\n",
            "a.inp: line 17: *ASSEMBLY: expected *END PART before it"},
           {"*PART,NAME=P\n" + mesh + "*END PART\n*INSTANCE,NAME=I,PART=Q\n",
            "a.inp: line 18: *INSTANCE: there is no part \"Q\""},
           {"*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=CPE3,ELSET=E\n1,1,2,3\n" + steel + "*DENSITY\n1\n" +
                section + begin + "*DLOAD\nE,GRAV,9.81,0,0,-1\n" + end,
            "a.inp: line 16: expected a direction of gravity in the plane of the body"},
           {mesh + "*ELEMENT,TYPE=S4,ELSET=SKIN\n2,5,6,7,8\n" + steel + section + begin +
                "*DLOAD\nSKIN,P1,1.\n" + end,
            "a.inp: line 25: element 2 is pressed and is no element of the body"}}) {
    const std::string got = refusal(deck), wanted = message;
    CAPTURE(got);
    CAPTURE(wanted);
    CHECK(got.starts_with(wanted));
  }
  CHECK(document(model + begin + "*BOUNDARY,OP=NEW\n" + held + "*CLOAD,OP=NEW\n" + load + end) ==
        document(plain));
  CHECK(document(model + begin + "*BOUNDARY,TYPE=displacement\nBOT,1,3\n" + load + end) == document(plain));
}

TEST_CASE("messages about a case of a deck name the line of the row") {
  const DeckCase bad =
      made(mesh + steel + "*PLASTIC\n250., 0.\n300., 0.1\n200., 0.2\n" + section + begin + held + end);
  CHECK(bad.with_line("material[0].plastic[2]: expected a stress") ==
        "a.inp: line 22: material[0].plastic[2]: expected a stress");
  CHECK(bad.with_line("material[0].young: expected") == "a.inp: line 18: material[0].young: expected");
  CHECK(bad.with_line("material[0]: unknown") == "a.inp: line 23: material[0]: unknown");
  CHECK(bad.with_line("material[01].plastic[2]: x") == "material[01].plastic[2]: x");
}

TEST_CASE("names and titles in another encoding are escaped, and stay apart") {
  const DeckCase latin = made("*HEADING\nTr\xe4ger\n*NODE,NSET=TR\xc4GER\n" +
                              plain.substr(plain.find("1,0,0,0")) + "** R\xe4nder\n");
  CHECK(latin.document["title"] == "Tr\\xe4ger");
  CHECK_NOTHROW(latin.document.dump());
  const std::string two = "*NSET,NSET=r\xe4\n1,2,3,4\n*NSET,NSET=r\xf6\n5,6,7,8\n";
  const DeckCase apart = made(mesh + two + steel + section + begin +
                              "*BOUNDARY\nR\xe4,1,3\nR\xf6,1\n*CLOAD\nr\xf6,3,-2.5\n" + end);
  CHECK(apart.document["boundary"].size() == 3);
  // A two-byte character at the position where the title is cut.
  const DeckCase cut = made("*HEADING\n" + std::string(199, 'x') + "\xc3\xa4\xc3\xa4\n" + plain);
  CHECK(cut.document["title"] == std::string(199, 'x'));
}
