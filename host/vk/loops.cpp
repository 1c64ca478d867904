#include "vk/loops.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "vk/spirv.h"

namespace vkcppm {
namespace {

using Word = std::uint32_t;
using Words = std::vector<Word>;

/// An instruction that can be changed.
struct Step {
    Words words;
    Code code;  // of other words: ask for the kind of an operand alone

    bool is_id(std::size_t word) const { return code.is_id(word); }
};

struct Block {
    Word label = 0;
    std::vector<Step> phis, rest;
    std::vector<Word> targets;   // where its end may go
    Word merge = 0, resume = 0;  // blocks behind and of the next trip of the loop that it is the header of
};

Step made(spv::Op op, bool typed, bool named, std::initializer_list<Word> operands) {
    Words words{first_word(op, operands.size() + 1)};
    words.insert(words.end(), operands.begin(), operands.end());
    return {words, Code{{}, op, typed, named, 0}};
}

class Closing {
public:
    Closing(std::span<const Word> spirv, const std::vector<Code>& code)
        : spirv_(spirv), code_(code), bound_(spirv[spirv_bound]) {}

    Words run() {
        Words out(spirv_.begin(), spirv_.begin() + spirv_header);
        std::size_t globals_end = 0;
        for (const Code& code : code_) {
            if (code.op == spv::OpDecorate && code.words[2] == spv::DecorationBuiltIn &&
                code.words[3] == spv::BuiltInLocalInvocationIndex) {
                invocation_ = code.words[1];
            }
            if (code.op == spv::OpTypeBool) bool_ = code.result();
            if (code.op == spv::OpFunction && globals_end == 0) globals_end = out.size();
            if (code.op == spv::OpTypeInt && code.words[3] == 0) uint_ = code.result();
            if (code.named) types_[code.result()] = code.type();
            if (code.op == spv::OpTypePointer) pointers_.insert(code.result());
            const bool in_block = code.op == spv::OpLabel || !blocks_.empty();
            if (code.op == spv::OpFunctionEnd) close_function(out);
            if (in_block && code.op != spv::OpFunctionEnd) {
                add(code);
            } else {
                out.insert(out.end(), code.words.begin(), code.words.end());
            }
        }
        out.insert(out.begin() + std::ptrdiff_t(globals_end), globals_.begin(), globals_.end());
        out[spirv_bound] = bound_;
        return out;
    }

private:
    void add(const Code& code) {
        if (code.op == spv::OpLabel) {
            blocks_.push_back({});
            blocks_.back().label = code.result();
            return;
        }
        Block& block = blocks_.back();
        const Instruction words = code.words;
        switch (code.op) {
            case spv::OpLoopMerge:
                block.merge = words[1];
                block.resume = words[2];
                return;  // add_exits() writes it again
            case spv::OpBranch: block.targets = {words[1]}; break;
            case spv::OpBranchConditional: block.targets = {words[2], words[3]}; break;
            case spv::OpSwitch:
                for (std::size_t i = 2; i < words.size(); i += 2) block.targets.push_back(words[i]);
                break;
            default: break;
        }
        (code.op == spv::OpPhi ? block.phis : block.rest).push_back({Words(words.begin(), words.end()), code});
    }

    /// 0 of a type.
    Word null_of(Word type) {
        Word& null = nulls_[type];
        if (null == 0) {
            null = bound_++;
            globals_.insert(globals_.end(), {first_word(spv::OpConstantNull, 3), type, null});
        }
        return null;
    }

    /// What is never true, which no optimizer knows: that an invocation has a number beyond all groups. Plainly false
    /// where the module does not number invocations, as all kernels with loops do.
    Word never() {
        if (invocation_ == 0) return null_of(bool_);
        if (most_ == 0) {
            most_ = bound_++;
            globals_.insert(globals_.end(), {first_word(spv::OpConstant, 4), uint_, most_, ~0u});
        }
        std::vector<Step>& first = blocks_.front().rest;
        const auto behind = std::ranges::find_if(first, [](const Step& s) { return s.code.op != spv::OpVariable; });
        const Word loaded = bound_++, result = bound_++;
        const Step steps[] = {made(spv::OpLoad, true, true, {uint_, loaded, invocation_}),
                              made(spv::OpIEqual, true, true, {bool_, result, loaded, most_})};
        first.insert(behind, std::begin(steps), std::end(steps));
        return result;
    }

    /// Parts the header of each loop behind its phis, and gives it the way out that is never taken.
    void add_exits() {
        if (std::ranges::all_of(blocks_, [](const Block& block) { return block.merge == 0; })) return;
        const Word taken = never();
        std::unordered_map<Word, Word> moved;      // a header's label to that of its second part
        std::unordered_map<Word, Word> header_of;  // by its merge block
        std::vector<Block> parted;
        for (Block& block : blocks_) {
            if (block.merge == 0) {
                parted.push_back(std::move(block));
                continue;
            }
            const Word second = bound_++;
            moved[block.label] = second;
            header_of[block.merge] = block.label;
            const Word resume = block.resume == block.label ? second : block.resume;
            Block head{block.label, std::move(block.phis), {}, {block.merge, second}, block.merge, resume};
            head.rest.push_back(made(spv::OpLoopMerge, false, false, {block.merge, resume, 0}));
            head.rest.push_back(made(spv::OpBranchConditional, false, false, {taken, block.merge, second}));
            parted.push_back(std::move(head));
            parted.push_back({second, {}, std::move(block.rest), std::move(block.targets), 0, 0});
        }
        blocks_ = std::move(parted);
        for (Block& block : blocks_) {
            for (Step& phi : block.phis) {
                for (std::size_t k = 4; k < phi.words.size(); k += 2) {
                    if (const auto to = moved.find(phi.words[k]); to != moved.end()) phi.words[k] = to->second;
                }
                if (const auto header = header_of.find(block.label); header != header_of.end()) {
                    phi.words.insert(phi.words.end(), {null_of(phi.words[1]), header->second});
                    phi.words[0] = first_word(spv::OpPhi, phi.words.size());
                }
            }
        }
    }

    void close_function(Words& out) {
        add_exits();
        std::unordered_map<Word, std::size_t> at;  // a block by its label
        for (std::size_t i = 0; i < blocks_.size(); ++i) at[blocks_[i].label] = i;
        std::multimap<Word, Word> before;  // blocks that go to a block
        for (const Block& block : blocks_) {
            std::vector<Word> targets = block.targets;
            std::ranges::sort(targets);
            targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
            for (const Word target : targets) before.emplace(target, block.label);
        }
        // Inner loops stand behind the headers of outer ones: what they hand on, these hand on.
        for (std::size_t header = blocks_.size(); header-- > 0;) {
            if (blocks_[header].merge != 0) close_loop(header, at.at(blocks_[header].merge), at, before);
        }
        for (const Block& block : blocks_) {
            out.insert(out.end(), {first_word(spv::OpLabel, 2), block.label});
            for (const auto* steps : {&block.phis, &block.rest}) {
                for (const Step& step : *steps) out.insert(out.end(), step.words.begin(), step.words.end());
            }
        }
        blocks_.clear();
    }

    /// Which blocks can be reached from the header without leaving its loop.
    std::vector<char> blocks_of_loop(std::size_t header, std::size_t merge,
                                     const std::unordered_map<Word, std::size_t>& at) const {
        std::vector<char> reached(blocks_.size());
        std::vector<std::size_t> waiting{header};
        while (!waiting.empty()) {
            const std::size_t block = waiting.back();
            waiting.pop_back();
            if (block == merge || std::exchange(reached[block], char(1))) continue;
            for (const Word target : blocks_[block].targets) waiting.push_back(at.at(target));
        }
        return reached;
    }

    void close_loop(std::size_t header, std::size_t merge, const std::unordered_map<Word, std::size_t>& at,
                    const std::multimap<Word, Word>& before) {
        const std::vector<char> in_loop = blocks_of_loop(header, merge, at);
        std::unordered_set<Word> inside;
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            // The header has phis alone: they keep what a lane had last.
            if (!in_loop[i] || i == header) continue;
            for (const auto* steps : {&blocks_[i].phis, &blocks_[i].rest}) {
                for (const Step& step : *steps) {
                    if (step.code.named && !pointers_.contains(step.words[1])) inside.insert(result_of(step));
                }
            }
        }
        const auto exits = before.equal_range(blocks_[merge].label);
        std::unordered_map<Word, Word> handed_on;  // to the result of its phi
        std::vector<Step> phis;
        const auto replace = [&](Word& id) {
            if (!inside.contains(id)) return;
            Word& phi = handed_on[id];
            if (phi == 0) {
                phi = bound_++;
                types_[phi] = types_[id];
                Words words{0, types_[id], phi};
                for (auto pair = exits.first; pair != exits.second; ++pair) {
                    const bool is_exit = pair->second == blocks_[header].label;  // that is never taken
                    words.insert(words.end(), {is_exit ? null_of(types_[id]) : id, pair->second});
                }
                words[0] = first_word(spv::OpPhi, words.size());
                phis.push_back({words, Code{{}, spv::OpPhi, true, true, 0}});
            }
            id = phi;
        };
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            for (Step& phi : blocks_[i].phis) {  // an operand is used where the block ends that it comes from
                for (std::size_t k = 3; k < phi.words.size(); k += 2) {
                    if (!in_loop[at.at(phi.words[k + 1])]) replace(phi.words[k]);
                }
            }
            if (in_loop[i]) continue;
            for (Step& step : blocks_[i].rest) {
                for (std::size_t k = step.code.first(); k < step.words.size(); ++k) {
                    if (step.is_id(k)) replace(step.words[k]);
                }
            }
        }
        blocks_[merge].phis.insert(blocks_[merge].phis.begin(), phis.begin(), phis.end());
    }

    static Word result_of(const Step& step) { return step.words[1 + step.code.typed]; }

    std::span<const Word> spirv_;
    const std::vector<Code>& code_;
    Word bound_;
    std::unordered_map<Word, Word> types_;  // of results
    std::unordered_set<Word> pointers_;     // types that are
    std::unordered_map<Word, Word> nulls_;  // by type
    Word bool_ = 0, uint_ = 0;              // types
    Word invocation_ = 0, most_ = 0;        // the variable of an invocation's number, and the largest number
    Words globals_;                         // new ones
    std::vector<Block> blocks_;             // of the function
};

}  // namespace

std::vector<std::uint32_t> with_loops_closed(std::span<const std::uint32_t> spirv) {
    if (std::ranges::count(instructions_of(spirv), spv::OpLoopMerge, opcode) == 0) return {spirv.begin(), spirv.end()};
    const auto code = code_of(spirv);
    if (!code) return {spirv.begin(), spirv.end()};
    return Closing(spirv, *code).run();
}

}  // namespace vkcppm
