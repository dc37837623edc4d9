#include "engine/joining/takers.h"

#include <algorithm>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "kernels/index.h"

namespace vfplan {
namespace {

using SetPiece = std::pair<std::int32_t, std::int32_t>;

}  // namespace

std::vector<std::int32_t> find_takers(const TakerProblem& p) {
    const auto sets = static_cast<std::int32_t>(p.joined.set_of_component.size());
    const auto cells = static_cast<std::int32_t>(p.joined.set_of_cell.size());
    const auto pieces_of = [&](std::int32_t cell) { return p.local.rows.row(p.candidates + cell); };
    std::vector<SetPiece> covered;  // by candidates
    for (const auto& [piece, component] : p.seen) {
        covered.emplace_back(p.joined.set_of_component[idx(component)], piece);
    }
    for (const std::int32_t c : p.joined.connectors) {
        for (const std::int32_t piece : pieces_of(c)) {
            covered.emplace_back(p.joined.set_of_cell[idx(c)], piece + p.first_piece);
        }
    }
    sort_once(covered);
    std::vector<SetPiece> seen = covered;  // from any cell
    std::vector<std::vector<std::int32_t>> cells_of(idx(sets));
    for (std::int32_t c = 0; c < cells; ++c) {
        const std::int32_t set = p.joined.set_of_cell[idx(c)];
        if (set >= 0 && set < sets) cells_of[idx(set)].push_back(c);  // others: no candidates
    }
    std::vector<std::int32_t> last(p.local.piece_length_m.size(),
                                   -1);  // set that a piece is noted of
    for (std::int32_t set = 0; set < sets; ++set) {
        for (const std::int32_t c : cells_of[idx(set)]) {
            for (const std::int32_t piece : pieces_of(c)) {
                if (last[idx(piece)] == set) continue;
                last[idx(piece)] = set;
                seen.emplace_back(set, piece + p.first_piece);
            }
        }
    }
    sort_once(seen);
    std::vector<double> length(idx(sets), 0);
    for (const auto& [set, piece] : seen) length[idx(set)] += p.pieces.length_m(piece);
    std::unordered_map<std::int32_t, std::int32_t> owner;
    for (const auto& [set, piece] : seen) {
        const auto [known, news] = owner.emplace(piece, set);
        if (!news && length[idx(set)] > length[idx(known->second)]) known->second = set;
    }
    // What owners lack, and who could cover it.
    std::vector<std::unordered_set<std::int32_t>> lacks(idx(sets));
    for (const auto& [set, piece] : seen) {
        if (owner[piece] != set) continue;
        if (std::binary_search(covered.begin(), covered.end(), SetPiece(set, piece))) continue;
        lacks[idx(set)].insert(piece);
    }
    const auto lacking = [&](std::int32_t c) {
        const auto row = pieces_of(c);
        const auto& lacks_of = lacks[idx(p.joined.set_of_cell[idx(c)])];
        return std::count_if(row.begin(), row.end(), [&](std::int32_t piece) {
            return lacks_of.contains(piece + p.first_piece);
        });
    };
    // What a cell can take only becomes less: what was counted before is never too little, and who
    // comes out on top when counted anew has most, of equals the first.
    using Entry = std::pair<std::int64_t, std::int32_t>;  // pieces, -cell
    std::priority_queue<Entry> most;
    for (std::int32_t c = 0; c < cells; ++c) {
        const std::int32_t set = p.joined.set_of_cell[idx(c)];
        if (set < 0 || set >= sets || lacks[idx(set)].empty()) continue;
        if (const auto n = lacking(c); n > 0) most.emplace(n, -c);
    }
    std::vector<std::int32_t> out;
    while (!most.empty()) {
        const auto [before, minus] = most.top();
        most.pop();
        const auto n = lacking(-minus);
        if (n < before) {
            if (n > 0) most.emplace(n, minus);
            continue;
        }
        for (std::int32_t c = -minus; c >= 0; c = p.joined.next[idx(c)]) {
            out.push_back(c);
            for (const std::int32_t piece : pieces_of(c)) {
                lacks[idx(p.joined.set_of_cell[idx(c)])].erase(piece + p.first_piece);
            }
        }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

}  // namespace vfplan
