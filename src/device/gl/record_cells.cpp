// SPDX-License-Identifier: MIT
// See record_cells.h.
#include "device/gl/record_cells.h"

#include <regex>

#include <fmt/format.h>

namespace talus::engine {
namespace {

constexpr std::size_t k_cell_words = 4;

struct Member {
    std::string type, name;
    std::size_t place = 0; ///< in words, of the record
    std::size_t words = 1;
};

/// In their order, and one after the last whose place is the record's size. Unaligned members would need padding that a
/// record does not have: see state/records.shared.glsl.
std::vector<Member> members_of(const std::string& body) {
    static const std::regex member(R"((?:^|\n)\s*(float|uint|vec3|vec4) (\w+);)");
    std::vector<Member> members;
    std::size_t place = 0;
    for (std::sregex_iterator at(body.begin(), body.end(), member), end; at != end; ++at) {
        const std::string type = (*at)[1];
        const std::size_t words = type == "vec4" ? 4 : type == "vec3" ? 3 : 1;
        members.push_back({type, (*at)[2], place, words});
        place += words;
    }
    members.push_back({"", "", place, 0});
    return members;
}

std::string unpacked(const Member& member) {
    const std::size_t first = member.place % k_cell_words;
    const std::string words =
        fmt::format("c.cell_{}.{}", member.place / k_cell_words, std::string_view("xyzw").substr(first, member.words));
    return member.type == "uint" ? words : "uintBitsToFloat(" + words + ")";
}

std::string packed(const Member& member) {
    return member.type == "uint" ? "r." + member.name : "floatBitsToUint(r." + member.name + ")";
}

void add_block(std::string& glsl, const std::string& name, std::size_t cells) {
    std::string loads, stores;
    for (std::size_t i = 0; i < cells; ++i) {
        loads += fmt::format("{}cell_in_block(blocks, index, {}u)", i == 0 ? "" : ", ", i);
        stores += fmt::format(" cell_in_block(blocks, index, {0}u) = cells.cell_{0};", i);
    }
    glsl += fmt::format("struct {0}CellBlock {{ uvec4 cells[{1}u * k_block_records]; }};\n"
                        "#define unpack_{0}(blocks, index) unpack({0}Cells({2}))\n"
                        "#define pack_{0}(blocks, index, record) {{ {0}Cells cells = pack(record);{3} }}\n",
                        name, cells, loads, stores);
}

std::string cells_of(const std::string& name, const std::vector<Member>& members) {
    const std::size_t cells = members.back().place / k_cell_words;
    std::string declared, read;
    std::vector<std::string> written(cells);
    for (std::size_t i = 0; i < cells; ++i)
        declared += fmt::format(" uvec4 cell_{};", i);
    for (const Member& member : members) {
        if (member.words == 0) continue;
        read += (read.empty() ? "" : ", ") + unpacked(member);
        std::string& cell = written[member.place / k_cell_words];
        cell += (cell.empty() ? "uvec4(" : ", ") + packed(member);
    }
    std::string glsl = fmt::format("struct {0}Cells {{{1} }};\n"
                                   "{0} unpack({0}Cells c) {{ return {0}({2}); }}\n"
                                   "{0}Cells pack({0} r) {{ return {0}Cells({3})); }}\n",
                                   name, declared, read, fmt::join(written, "), "));
    add_block(glsl, name, cells);
    return glsl;
}

} // namespace

std::vector<RecordCells> record_cells(std::string_view records) {
    static const std::regex record(R"(struct (\w+) \{([^}]*)\};)");
    const std::string text(records);
    std::vector<RecordCells> all;
    for (std::sregex_iterator at(text.begin(), text.end(), record), end; at != end; ++at) {
        const std::vector<Member> members = members_of((*at)[2]);
        if (members.back().place % k_cell_words == 0) all.push_back({(*at)[1], cells_of((*at)[1], members)});
    }
    return all;
}

std::string cells_for(std::string_view kernel, const std::vector<RecordCells>& all) {
    std::string glsl =
        "#define cell_in_block(blocks, index, cell) "
        "blocks[(index) / k_block_records].cells[(cell) * k_block_records + (index) % k_block_records]\n";
    for (const RecordCells& each : all) { // a kernel that has them declares a block of RCells, or of RCellBlock
        if (kernel.find(each.record + "Cell") != std::string_view::npos) glsl += each.glsl;
    }
    return glsl;
}

} // namespace talus::engine
