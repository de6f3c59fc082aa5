// Lines that the reference may refuse: known mistakes, and codes with words by chance. Whether a
// line is refused, and if not what it does, must be the same.
#include <cctype>
#include <string>

#include "peer/program_maker.h"

namespace aircut::test {

/// Some of `letters` as words, most of them with a usable value; a small letter is that of an
/// integer of 0 or more.
std::string ProgramMaker::wild_words(const std::string& letters) {
  std::string words;
  for (const char letter : letters) {
    if (!one_in(2)) continue;
    words += std::string(" ") + static_cast<char>(std::toupper(letter));
    switch (letter) {
      case 'p':
      case 'e':
      case 'q':
        words += std::to_string(below(4));
        break;
      case 'P':
      case 'L':
      case 'H':
      case 'D':
      case 'T':
      case 'E':
        words += one_in(5) ? decimal(0, 3) : std::to_string(below(4));
        break;
      case 'F':
      case 'S':
        words += one_in(8) ? "-1" : std::to_string(below(200));
        break;
      case '$':
        words += pick({"0", "0", "1"});
        break;
      default:
        words += decimal(-9, 9);
    }
  }
  return words;
}

void ProgramMaker::wild() {
  if (!knows_tool_) return;  // the reference's stand-in does not know the tool of M61
  struct Code {
    const char *code, *words;
  };
  static constexpr Code codes[] = {{"G0", "XYZAB"},
                                   {"G1", "XYZAF"},
                                   {"G2", "XYZIJKRP"},
                                   {"G3", "XYZIJKRP"},
                                   {"G4", "PX"},
                                   {"G5", "XYZIJPQ"},
                                   {"G5.1", "XYZIJ"},

                                   {"G5.3", "XP"},
                                   {"G7", "X"},
                                   {"G8", "X"},
                                   {"G10", "LXYZRIJq"},
                                   {"G10 L2", "pXYZAR"},
                                   {"G10 L20", "pXYZR"},
                                   {"G10 L1", "pXZRIJq"},
                                   {"G10 L10", "pXZR"},
                                   {"G10 L11", "pXZ"},
                                   {"G17", "XY"},
                                   {"G18", "Z"},
                                   {"G19", "X"},
                                   {"G20", "X"},
                                   {"G21", "F"},
                                   {"G28", "XYZA"},
                                   {"G28.1", "X"},
                                   {"G30", "XYZB"},
                                   {"G30.1", "P"},
                                   {"G33", "XZKF$"},
                                   {"G33.1", "XZKF$"},
                                   {"G40", "XD"},
                                   {"G41", "DX"},
                                   {"G42", "DXL"},
                                   {"G41.1", "DXL"},
                                   {"G42.1", "DL"},
                                   {"G43", "HZ"},
                                   {"G43.1", "XYZAH"},
                                   {"G43.2", "H"},
                                   {"G49", "HZ"},
                                   {"G52", "XYZA"},
                                   {"G53", "XYZ"},
                                   {"G53 G0", "XYZ"},
                                   {"G53 G1", "XAF"},
                                   {"G54", "X"},
                                   {"G59.3", "X"},
                                   {"G61", "P"},
                                   {"G61.1", "X"},
                                   {"G64", "PQX"},
                                   {"G73", "XYZRQLP"},
                                   {"G74", "XYZRPL$"},
                                   {"G76 Z-9", "PIJKRQHELX"},
                                   {"G80", "XL"},
                                   {"G81", "XYZRLP"},
                                   {"G82", "XYZRLP"},
                                   {"G83", "XYZRLQ"},
                                   {"G84", "XYZRLP$"},
                                   {"G85", "XYZRL"},
                                   {"G86", "XYZRLP$"},
                                   {"G87", "XYZRLIJK"},
                                   {"G88", "XYZRLP"},
                                   {"G89", "XYZRLPA"},
                                   {"G90", "X"},
                                   {"G91", "XZ"},
                                   {"G90.1", "IX"},
                                   {"G91.1", "I"},
                                   {"G92", "XYZA"},
                                   {"G92.1", "X"},
                                   {"G92.2", "X"},
                                   {"G92.3", "Y"},
                                   {"G93", "FX"},
                                   {"G94", "FX"},
                                   {"G95", "FX"},
                                   {"G96", "S$"},
                                   {"G97", "SD$"},
                                   {"G98", "XR"},
                                   {"G99", "XR"},
                                   {"M0", "X"},
                                   {"M1", ""},
                                   {"M3", "S$P"},
                                   {"M4", "S$"},
                                   {"M5", "$"},
                                   {"M7", "X"},
                                   {"M8", "X"},
                                   {"M9", ""},
                                   {"M19", "RPQ$"},
                                   {"M48", "P"},
                                   {"M49", ""},
                                   {"M50", "p"},
                                   {"M51", "p"},
                                   {"M52", "p"},
                                   {"M53", "p"},
                                   {"M60", ""},
                                   {"M62", "pq"},
                                   {"M63", "p"},
                                   {"M64", "p"},
                                   {"M65", "p"},
                                   {"M66", "peLQ"},
                                   {"M67", "eQP"},
                                   {"M68", "eQ"},
                                   {"", "XYZABCIJKLPQRDEFHST$@^"},
                                   {"G0", "@^Z"},
                                   {"G1", "@^XF"},
                                   {"G2", "@^IJR"},
                                   {"G81", "@^ZRL"},
                                   {"G17.1", "X"},
                                   {"G19.1", "U"},
                                   {"M30", "X"},
                                   {"M2", "P"},
                                   {"G0 G40", "XY"}};
  const auto& first = codes[below(std::size(codes))];
  std::string line = first.code + wild_words(first.words);
  if (one_in(3)) {
    const auto& second = codes[below(std::size(codes))];
    line += std::string(" ") + second.code;
    // Words of the second that the first has not: a letter twice is refused at once.
    std::string letters;
    for (const char* letter = second.words; *letter; ++letter)
      if (std::string(first.words).find_first_of({*letter, char(*letter ^ 32)}) ==
          std::string::npos)
        letters += *letter;
    line += wild_words(letters);
  }
  if (one_in(6)) line += wild_words("FS");
  if (line.empty()) line = "G80";
  add(line);
  // What it led to.
  add("G0 X1");
  add("(DEBUG,#<_motion_mode> #<_plane> #<_feed> #<_rpm> #<_spindle_on> #<_ccomp> #<_metric>)");
}

/// They end the comparison, so they are rare.
void ProgramMaker::hostile() {
  if (!one_in(4)) return line_move();
  if (one_in(2) && knows_tool_) return wild();
  add(pick({"G1 X",
            "G0 X1 X2",
            "G2 X1 Y1",
            "G2 X50 Y50 R2",
            "G0 G1 X1",
            "M3 M4",
            "X[1/0]",
            "#5400=1",
            "#5700=1",
            "G0 X#<nobody>",
            "G0 X[1+",
            "G0 X1 P2",
            "G10 L2 P99 X1",
            "G10 X1",
            "T77",
            "G43 H55",
            "G81 X1 Z-1",
            "G83 X1 Z-1 R1",
            "G81 X1 Z5 R1",
            "G4",
            "G4 P-1",
            "G53 X1 G2",
            "G33 Z-1",
            "G5 X1 Y1",
            "G77",
            "M20",
            "G0 U1",
            "G41.1",
            "G92",
            "G52",

            "X1e3",
            "G0 (a (b) c)",
            "(unclosed",
            "M62",
            "G64 P-1",
            "F-1",
            "S-1",
            "G10 L20 P1 X1 R1",
            "G10 L1 P1",
            "G1 @5 X1",
            "o1 endif",
            "o5 call",
            "G61 G64",
            "G2 I0 J0",
            "G3 X1 Y1 I100",
            "M66 P1 L3",
            "M72",
            "G93 G81 X1 Z-1 R1 F1",
            "G0 X1 R1",
            "G90.1 G2 I1",
            "G19 G2 I1 J1",
            "G20.5",
            "G0 X.",
            "G0 X1.2.3",
            "N5 N6",
            "G0 X#0",
            "G1 X1 F0",
            "M3 M7 M48 M61 M0",
            "G76 X1",
            "G0 X1 $",
            "g",
            "x",
            "#1",
            "#1=",
            "[1]",
            "G17.2",
            "G0 Xsqrt[-1]",
            "G0 Xacos[2]",
            "G5.1 X1 Y1 I1",
            "G30.2",
            "G0 X--5",
            "G0 X-[2]",
            "G0 X+-5",
            "G00000 X1",
            "G1.00001 X1",
            "G0 X1 Y",
            "X1,5",
            "G0 X0x10",
            "G0 Xatan[1]",
            "G0 Xatan[1]/2",
            "G0 Xfoo[1]",
            "#1=[1 is 2]",
            "#1=[2 mod 0]",
            "#1=[0 ** -1]",
            "#1=[-2 ** 0.5]",
            "#1=ln[0]",
            "#1=exp[1000]",
            "#1=[1 +* 2]",
            "#1=[[1]",
            "#1=[1]]",
            "#1=exists[1]",
            "#1=exists[#0]",
            "#1=exists[#5602] #2=exists[#5601]",
            "#1=exists[#2.5]",
            "(DEBUG,%.1x#1 %.f#2 %.#3)",
            "#1=exists[#1]",
            "#<a b = 3",

            "#<_x>=1",
            "#1.5=2",
            "#[1.5]=2",
            "#[-1]=2",
            "#5601=1",
            "#5602=1",
            "#5161=1 #5221=2",
            "#5420=1",
            "#5599=1",
            "#5060=3",
            "#5070=1",
            "#5399=4",
            "#5220=3",
            "#5220=12",
            "#1=#5601",

            "#1=exists[#<_ini[A]B>]",
            "#1=#<_vmajor>",
            "#1=#<_task>",
            "o<a> if",
            "o7 if [1] G0",
            "o7 while",
            "o7 repeat",
            "o7 foo",
            "o7",
            "o if [1]",
            "o1.5 if [1]",
            "o7 break",
            "o7 continue",
            "o7 else",
            "o7 endsub",
            "o7 endrepeat",
            "o7 sub\no8 sub\no8 endsub\no7 endsub",
            "o7 sub\no7 endsub [1/0]\no7 call",
            "o7 if [1]\nG0 X1\no8 endif\no7 endif",
            "o7 call [1",
            "o7 call 1",
            "o<nofile> call",
            "o<../x> call",
            "o<mover> call [1] [2] [3] [4] [5] [6] [7] [8] [9] [10] [11] [12] [13] [14] [15] [16]"
            " [17] [18] [19] [20] [21] [22] [23] [24] [25] [26] [27] [28] [29] [30] [31]",
            "M98 P77",
            "M98",
            "M99 P3",
            "O77",
            "%",
            "(ABORT,because #1)",
            "/G0 X3",
            "//G0 X3",
            "N1.5 G0 X1",
            "N-1 G0 X1",
            "N99999 G0 X2",
            "G0 N5 X1",
            "M3.5",
            "M-1",
            "G-1",
            "G100",
            "M200",

            "G41 D1\nG41 D1",
            "G42 D3",
            "G41 D77",
            "G41.1 D5 L3",
            "G41\nG28",
            "G41\nG53 G0 X1",
            "G19\nG41",
            "G91 G53 G0 X1",
            "G95 S0\nG1 X1",
            "M5\nG33 Z-1 K1",
            "M5\nG84 Z-1 R1",
            "M5\nG86 Z-1 R1 P1",
            "M4\nG84 Z-1 R1",
            "M3\nG74 Z-1 R1",
            "G5.2 X1 Y1 P1 L3\nX2 Y2 P0\nG5.3",
            "G5.2 X1 Y1 P1 L4\nX2 Y2 P1\nG5.3",
            "G5.3",
            "G17.1\nG81 X1 Z-1 R1",
            "G17.1 G2 X1 I1",
            "G18\nG5 X1 Y1 I1 J1 P1 Q1",

            "G10 L3 P1",
            "G10 P1 X1",
            "G10 L2 X1",
            "G10 L1 P77 X1",
            "G10 L1 P2 Q10",

            "G10 L20 P10 X1",
            "G43.1",
            "G43.2",
            "G43 H-1",
            "M61",
            "M61 Q77",
            "M61 Q-1",
            "M6",
            "T-1",
            "T1.5",
            "S100 $5",
            "M3 $-2",
            "G96",

            "G96 S100 D-5",
            "G4 P",
            "G64 P0 Q-1",
            "G80 X1",
            "G73 X1 Z-1 R1 Q0",
            "G73 X1 Z-1 R1 Q-1",
            "G82 X1 Z-1 R1",
            "G82 X1 Z-1 R1 P-1",
            "G81 X1 Z-1 R1 L0",
            "G81 X1 Z-1 R1 L-1",
            "G81 X1 Z-1 R1 L1.5",
            "G81 X1 Z-1 R1 A1",
            "G53 G81 X1 Z-1 R1",
            "G81 X1 Z-1 R1 G49",

            "G93\nG1 X1",

            "G95\nG38.2 X1 F1",
            "G28 G0 X1",
            "G92 G1 X1",
            "G28 G92 X1",
            "G10 L2 P1 X1 G28",
            "G43.1 Z1 G92 X1",
            "G4 P1 G10 L2 P1 X1",
            "G4 P1 G92 X1",
            "G90 G91 X1",
            "G17 G18",
            "M0 M2",
            "M7 M8",
            "M48 M49",
            "M62 P1 M63 P2",
            "M19",
            "M19 R361",
            "M19 R-1",
            "M19 R10 P3",
            "M19 R10 Q0",
            "G76 P1 Z-10 I0 J0.2 K1",
            "G76 P1 Z-10 I-1 J0 K1",
            "G76 P1 Z-10 I-1 J2 K1",

            "G76 P1 Z-10 I-1 J0.2 K1 H1.5",

            "G33 Z-1 K1 F5",
            "G33 K1"}));
}

}  // namespace aircut::test
