#include "vk/fold.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "vk/spirv.h"

namespace vkcppm {
namespace {

using Word = std::uint32_t;
using Words = std::vector<Word>;

/// An operation on booleans (0, 1) or integers of 32 bits, where it is known and defined. One operand: b is 0.
std::optional<Word> computed(spv::Op op, Word a, Word b) {
    const auto sa = std::int32_t(a), sb = std::int32_t(b);
    switch (op) {
        case spv::OpCopyObject:
        case spv::OpBitcast: return a;
        case spv::OpNot: return ~a;
        case spv::OpSNegate: return 0u - a;
        case spv::OpLogicalNot: return a ^ 1u;
        case spv::OpIAdd: return a + b;
        case spv::OpISub: return a - b;
        case spv::OpIMul: return a * b;
        case spv::OpUDiv: return b == 0 ? std::nullopt : std::optional(a / b);
        case spv::OpUMod: return b == 0 ? std::nullopt : std::optional(a % b);
        case spv::OpSDiv: return sb == 0 || sb == -1 ? std::nullopt : std::optional(Word(sa / sb));
        case spv::OpShiftRightLogical: return b > 31 ? std::nullopt : std::optional(a >> b);
        case spv::OpShiftRightArithmetic: return b > 31 ? std::nullopt : std::optional(Word(sa >> b));
        case spv::OpShiftLeftLogical: return b > 31 ? std::nullopt : std::optional(a << b);
        case spv::OpLogicalAnd:
        case spv::OpBitwiseAnd: return a & b;
        case spv::OpLogicalOr:
        case spv::OpBitwiseOr: return a | b;
        case spv::OpBitwiseXor: return a ^ b;
        case spv::OpLogicalEqual:
        case spv::OpIEqual: return a == b;
        case spv::OpLogicalNotEqual:
        case spv::OpINotEqual: return a != b;
        case spv::OpUGreaterThan: return a > b;
        case spv::OpSGreaterThan: return sa > sb;
        case spv::OpUGreaterThanEqual: return a >= b;
        case spv::OpSGreaterThanEqual: return sa >= sb;
        case spv::OpULessThan: return a < b;
        case spv::OpSLessThan: return sa < sb;
        case spv::OpULessThanEqual: return a <= b;
        case spv::OpSLessThanEqual: return sa <= sb;
        default: return std::nullopt;
    }
}

/// What one side of an operation may be so that the other does not matter: the result is that, or the other side.
struct Side {
    std::optional<Word> absorbs, passes;
};
Side side_of(spv::Op op) {
    switch (op) {
        case spv::OpLogicalAnd: return {0u, 1u};
        case spv::OpLogicalOr: return {1u, 0u};
        case spv::OpBitwiseAnd: return {0u, ~0u};
        case spv::OpBitwiseOr: return {~0u, 0u};
        case spv::OpIMul: return {0u, 1u};
        case spv::OpIAdd: return {{}, 0u};
        default: return {};
    }
}

/// Sparse conditional constant propagation (Wegman, Zadeck 1991), over blocks in their order until nothing changes
/// instead of work lists: only what goes round a loop takes another turn.
class Propagation {
public:
    Propagation(std::span<const Word> spirv, const std::vector<Code>& code, const Specialization& constants)
        : code_(code), header_(spirv.first(spirv_header)), ids_(spirv[spirv_bound]), given_(constants) {}

    /// The module without constants to specialise and without blocks that are not reached; none where it has what is
    /// not known here.
    std::optional<Words> run() {
        if (!read_globals() || !read_blocks()) return std::nullopt;
        do {
            changed_ = false;
            for (const Block& block : blocks_) visit(block);
        } while (changed_);
        if (!find_stubs()) return std::nullopt;
        return written();
    }

private:
    /// Of an id: what it always is. A value is the id of a constant, of what it is a copy of, or itself where nothing
    /// more is known; 0 where it was not yet seen to be computed.
    struct Id {
        Word value = 0;
        Word bits = 0;         // of a constant that is a boolean or an integer of 32 bits
        bool known = false;    // it is such a constant
        bool scalar = false;   // it is the type of such
        bool global = false;   // it stands before all functions
        std::uint32_t at = 0;  // index of its instruction, of a label that of its block
    };
    /// `first` is its label's instruction and `last` its terminator's.
    struct Block {
        std::size_t first = 0, last = 0;
        bool reached = false;
        // What it holds where it is not reached but named, as merge block or as a loop's continue target.
        Words stub = {};
    };

    /// The id of the constant of that type and bits: of one that is there, else `fresh`, else a new one.
    Word constant(Word type, Word bits, Word fresh = 0) {
        auto [at, added] = constants_.try_emplace(std::uint64_t(type) << 32 | bits, fresh);
        if (!added) return at->second;
        if (fresh == 0) at->second = added_global(constant_words(type, 0, bits));
        Id& id = ids_[at->second];
        id.value = at->second;
        id.bits = bits;
        id.known = true;
        return at->second;
    }

    Words constant_words(Word type, Word id, Word bits) const {
        if (code_[ids_[type].at].op == spv::OpTypeInt) return {first_word(spv::OpConstant, 4), type, id, bits};
        return {first_word(bits != 0 ? spv::OpConstantTrue : spv::OpConstantFalse, 3), type, id};
    }

    /// The new id of an instruction behind all others that stand before functions.
    Word added_global(Words words) {
        const auto id = Word(ids_.size());
        ids_.push_back({.value = id, .global = true});
        words[2] = id;
        added_.insert(added_.end(), words.begin(), words.end());
        return id;
    }

    bool read_globals() {
        std::map<Word, Word> spec_ids;  // by the constant's id
        for (; functions_ < code_.size() && code_[functions_].op != spv::OpFunction; ++functions_) {
            const Code& code = code_[functions_];
            const Instruction words = code.words;
            if (code.op == spv::OpDecorate && words[2] == spv::DecorationSpecId) spec_ids[words[1]] = words[3];
            if (!code.named) continue;
            const Word result = code.result(), type = code.type();
            Id& id = ids_[result];
            id.value = result;
            id.at = std::uint32_t(functions_);
            id.global = true;
            const auto is = [&](Word bits) { ids_[result].value = constant(type, bits, result); };
            id.scalar = code.op == spv::OpTypeBool || code.op == spv::OpTypeInt;
            const bool scalar = ids_[type].scalar;
            if (code.op == spv::OpConstantTrue) is(1);
            if (code.op == spv::OpConstantFalse) is(0);
            if (code.op == spv::OpConstant && scalar) is(words[3]);
            // Not one that others become: the index of a member must not be a null.
            if (code.op == spv::OpConstantNull && scalar) id.known = true;
            if (code.op == spv::OpSpecConstant) {
                if (!scalar) return false;
                const auto given = spec_ids.contains(result) ? given_.find(spec_ids[result]) : given_.end();
                is(given == given_.end() ? words[3] : given->second);
            }
            if (code.op == spv::OpSpecConstantOp) {
                const Word value = evaluated(spv::Op(words[3]), type, result, words.subspan(4));
                if (!ids_[value].known) return false;
                ids_[result].value = value;
            }
        }
        return true;
    }

    /// What an operation gives: an id as in Id::value. `fresh` is its own.
    Word evaluated(spv::Op op, Word type, Word fresh, Instruction operands) {
        const auto value = [&](std::size_t i) { return ids_[operands[i]].value; };
        const auto known = [&](std::size_t i) -> std::optional<Word> {
            const Id& id = ids_[value(i)];
            return id.known ? std::optional(id.bits) : std::nullopt;
        };
        if (op == spv::OpCompositeExtract) {
            Word whole = value(0);
            for (const Word member : operands.subspan(1)) {
                const Id& id = ids_[whole];
                if (!id.global) return fresh;
                const Code& code = code_[id.at];
                if (code.op != spv::OpConstantComposite && code.op != spv::OpSpecConstantComposite) return fresh;
                whole = ids_[code.operands()[member]].value;
            }
            return whole;
        }
        if (op == spv::OpSelect) {
            if (const auto condition = known(0)) return value(*condition != 0 ? 1 : 2);
            return value(1) == value(2) ? value(1) : fresh;
        }
        if (!ids_[type].scalar || !computed(op, 1, 1)) return fresh;
        const auto a = known(0), b = operands.size() == 2 ? known(1) : 0u;
        if (a && b) {
            const auto bits = computed(op, *a, *b);
            // A new constant that stands before functions takes the place of its operation.
            return bits ? constant(type, *bits, ids_[fresh].global ? fresh : 0) : fresh;
        }
        if (!a && !b) return fresh;
        const auto [absorbs, passes] = side_of(op);
        const Word bits = a ? *a : *b;
        if (bits == absorbs) return constant(type, bits);
        const Word other = value(a ? 1 : 0);
        return bits == passes && type_of(other) == type ? other : fresh;
    }

    Word type_of(Word id) const { return code_[ids_[id].at].type(); }

    /// Labels become blocks. Every branch must go forward but for those back to a loop's header: then blocks that are
    /// dropped leave all others behind those that dominate them, and one turn goes over what there is to know but for
    /// loops.
    bool read_blocks() {
        bool entry = false, inside = false;  // a block
        for (std::size_t i = functions_; i < code_.size(); ++i) {
            const Code& code = code_[i];
            Id& id = ids_[code.result()];
            id.at = std::uint32_t(i);
            if (code.op == spv::OpFunction) entry = true;
            if (code.op == spv::OpFunctionEnd) inside = false;
            if (code.op == spv::OpLabel) {
                inside = true;
                id.at = std::uint32_t(blocks_.size());
                blocks_.push_back({.first = i, .reached = std::exchange(entry, false)});
            }
            if (inside) blocks_.back().last = i;
            if (!inside || code.op == spv::OpLabel) id.value = code.result();
        }
        for (const Block& block : blocks_) {
            bool forward = true;
            each_target(block, [&](Word label) { forward = forward && (!goes_back(block, label) || loops(label)); });
            if (!forward) return false;
        }
        return true;
    }

    Word label_of(const Block& block) const { return code_[block.first].result(); }
    const Block& block_of(Word label) const { return blocks_[ids_[label].at]; }
    bool goes_back(const Block& from, Word label) const { return block_of(label).first <= from.first; }
    const Code* merge_of(const Block& block) const {
        const Code& code = code_[block.last - 1];
        return code.op == spv::OpLoopMerge || code.op == spv::OpSelectionMerge ? &code : nullptr;
    }
    bool loops(Word label) const {
        const Code* merge = merge_of(block_of(label));
        return merge && merge->op == spv::OpLoopMerge;
    }

    /// The one label that a branch of several goes to where that is known; 0: it is not. A loop keeps its way back.
    Word chosen(const Block& block) const {
        const Code& end = code_[block.last];
        if (end.op != spv::OpBranchConditional && end.op != spv::OpSwitch) return 0;
        const Instruction words = end.words;
        const Id& selector = ids_[ids_[words[1]].value];
        if (!selector.known) return 0;
        if (end.op == spv::OpSwitch) {
            for (std::size_t i = 3; i < words.size(); i += 2) {
                if (words[i] == selector.bits) return words[i + 1];
            }
            return words[2];
        }
        if (goes_back(block, words[2]) || goes_back(block, words[3])) return 0;
        return selector.bits != 0 ? words[2] : words[3];
    }

    /// Calls `take` with the labels that the block's terminator names.
    template <typename Take> void each_target(const Block& block, Take take) const {
        const Code& end = code_[block.last];
        const Instruction words = end.words;
        if (end.op == spv::OpBranch) take(words[1]);
        if (end.op == spv::OpBranchConditional || end.op == spv::OpSwitch) take(words[2]);
        if (end.op == spv::OpBranchConditional) take(words[3]);
        for (std::size_t i = 4; end.op == spv::OpSwitch && i < words.size(); i += 2) take(words[i]);
    }

    /// The same of those that it can go to.
    template <typename Take> void each_successor(const Block& block, Take take) const {
        if (!block.reached) return;
        if (const Word label = chosen(block)) return take(label);
        each_target(block, take);
    }

    bool goes(Word from, Word to) const {
        bool found = false;
        each_successor(block_of(from), [&](Word label) { found = found || label == to; });
        return found;
    }

    void visit(const Block& block) {
        if (!block.reached) return;
        const Word label = label_of(block);
        for (std::size_t i = block.first + 1; i <= block.last; ++i) {
            const Code& code = code_[i];
            const Word result = code.result();
            if (result == 0 || ids_[result].value == result) continue;
            const Word value =
                code.op == spv::OpPhi ? met(code, label) : evaluated(code.op, code.type(), result, code.operands());
            const Word before = ids_[result].value;
            if (value == before || value == 0) continue;
            // From a constant to a copy to itself and never back, so that it ends.
            const bool falls = before == 0 || (ids_[before].global && !ids_[value].global);
            ids_[result].value = falls ? value : result;
            changed_ = true;
        }
        each_successor(block, [&](Word next) {
            changed_ = changed_ || !block_of(next).reached;
            blocks_[ids_[next].at].reached = true;
        });
    }

    /// What a phi of the block always is, as far as is known: all that comes in where that is one value.
    Word met(const Code& phi, Word label) const {
        const Instruction pairs = phi.operands();
        Word value = 0;
        for (std::size_t i = 0; i < pairs.size(); i += 2) {
            const Word incoming = ids_[pairs[i]].value;
            if (incoming == 0 || incoming == value || !goes(pairs[i + 1], label)) continue;
            if (value != 0) return phi.result();
            value = incoming;
        }
        return value;
    }

    /// Blocks that are not reached but that a merge instruction which stays names. False where the way round a loop is
    /// lost, or a branch out of a selection that is none any more.
    bool find_stubs() {
        std::vector<Word> dropped;  // merge blocks of selections that are none any more
        for (const Block& block : blocks_) {
            const Code* merge = block.reached ? merge_of(block) : nullptr;
            if (!merge) continue;
            if (merge->op == spv::OpSelectionMerge && code_[block.last].op != spv::OpSwitch && chosen(block) != 0) {
                dropped.push_back(merge->words[1]);
                continue;
            }
            Block& end = blocks_[ids_[merge->words[1]].at];
            if (!end.reached && end.stub.empty()) end.stub = {first_word(spv::OpUnreachable, 1)};
            if (merge->op != spv::OpLoopMerge) continue;
            Block& next = blocks_[ids_[merge->words[2]].at];
            const Word header = label_of(block);
            if (!next.reached) next.stub = {first_word(spv::OpBranch, 2), header};
            bool back = !next.reached;
            for (std::size_t i = ids_[header].at; !back && i < blocks_.size(); ++i) {
                each_successor(blocks_[i], [&](Word label) { back = back || label == header; });
            }
            if (!back) return false;
        }
        std::ranges::sort(dropped);
        for (const Block& block : blocks_) {
            if (merge_of(block) || chosen(block) != 0 || code_[block.last].op != spv::OpBranchConditional) continue;
            bool leaves = false;
            each_successor(block, [&](Word label) { leaves = leaves || std::ranges::binary_search(dropped, label); });
            if (leaves) return false;
        }
        return true;
    }

    void write(Words& out, const Code& code) const {
        for (std::size_t i = 0; i < code.words.size(); ++i) {
            out.push_back(i > 0 && code.is_id(i) ? ids_[code.words[i]].value : code.words[i]);
        }
    }

    Words written() {
        Words body;
        for (std::size_t i = functions_; i < code_.size(); ++i) {
            if (code_[i].op != spv::OpLabel) {
                write(body, code_[i]);
                continue;
            }
            const Block& block = block_of(code_[i].result());
            write_block(body, block);
            i = block.last;
        }
        Words out(header_.begin(), header_.end());
        for (std::size_t i = 0; i < functions_; ++i) write_global(out, code_[i]);
        out.insert(out.end(), added_.begin(), added_.end());
        out.insert(out.end(), body.begin(), body.end());
        out[spirv_bound] = Word(ids_.size());
        return out;
    }

    void write_global(Words& out, const Code& code) const {
        if (code.op == spv::OpDecorate && code.words[2] == spv::DecorationSpecId) return;
        const Word result = code.result();
        if (code.op == spv::OpEntryPoint || code.is_about()) {  // of an id, not of what has its value
            out.insert(out.end(), code.words.begin(), code.words.end());
        } else if (result == 0 || ids_[result].value == result) {
            if (ids_[result].known && code.op != spv::OpConstantNull) {
                const Words words = constant_words(code.type(), result, ids_[result].bits);
                out.insert(out.end(), words.begin(), words.end());
                return;
            }
            const std::size_t at = out.size();
            write(out, code);
            if (code.op == spv::OpSpecConstantComposite) {
                out[at] = first_word(spv::OpConstantComposite, code.words.size());
            }
        }
    }

    void write_block(Words& out, const Block& block) {
        if (!block.reached && block.stub.empty()) return;
        out.insert(out.end(), {first_word(spv::OpLabel, 2), label_of(block)});
        out.insert(out.end(), block.stub.begin(), block.stub.end());
        if (!block.reached) return;
        const Word target = chosen(block);
        for (std::size_t i = block.first + 1; i <= block.last; ++i) {
            const Code& code = code_[i];
            const bool ends = i == block.last && target != 0;
            if (code.named && ids_[code.result()].value != code.result()) continue;
            if (code.op == spv::OpPhi) {
                write_phi(out, code, block);
            } else if (ends && code.op == spv::OpSwitch) {
                out.insert(out.end(), {first_word(spv::OpSwitch, 3), ids_[code.words[1]].value, target});
            } else if (ends) {
                out.insert(out.end(), {first_word(spv::OpBranch, 2), target});
            } else if (code.op != spv::OpSelectionMerge || target == 0 || code_[block.last].op == spv::OpSwitch) {
                write(out, code);
            }
        }
    }

    /// With those that come in, and what comes from a continue target that is a stub: anything.
    void write_phi(Words& out, const Code& phi, const Block& block) {
        const std::size_t at = out.size();
        const Word label = label_of(block);
        out.insert(out.end(), {0, phi.type(), phi.result()});
        const Instruction pairs = phi.operands();
        for (std::size_t i = 0; i < pairs.size(); i += 2) {
            if (goes(pairs[i + 1], label)) out.insert(out.end(), {ids_[pairs[i]].value, pairs[i + 1]});
        }
        const Code* merge = merge_of(block);
        if (merge && merge->op == spv::OpLoopMerge && !block_of(merge->words[2]).reached) {
            Word& undefined = undefined_[phi.type()];
            if (undefined == 0) undefined = added_global({first_word(spv::OpUndef, 3), phi.type(), 0});
            out.insert(out.end(), {undefined, merge->words[2]});
        }
        out[at] = first_word(spv::OpPhi, out.size() - at);
    }

    const std::vector<Code>& code_;
    std::span<const Word> header_;
    std::vector<Id> ids_;
    const Specialization& given_;
    std::vector<Block> blocks_;
    std::unordered_map<std::uint64_t, Word> constants_;  // by type and bits
    std::unordered_map<Word, Word> undefined_;           // by type
    Words added_;
    std::size_t functions_ = 0;  // index of the first
    bool changed_ = false;
};

/// The module without results that nobody uses, stores to local variables that nobody reads, and what is said of
/// either.
Words without_dead_code(const Words& spirv) {
    const std::vector<Code> code = *code_of(spirv);
    std::vector<const Code*> defined(spirv[spirv_bound]);
    std::vector<char> used(spirv[spirv_bound]);
    std::vector<Word> waiting;
    std::unordered_map<Word, std::vector<const Code*>> stores;  // by the local variable, while nobody reads it
    const auto use = [&](Word id) {
        if (!std::exchange(used[id], char(1))) waiting.push_back(id);
    };
    const auto use_operands = [&](const Code& of) {
        for (std::size_t i = 1; i < of.words.size(); ++i) {
            if (of.is_id(i)) use(of.words[i]);
        }
    };
    /// The local variable that a store goes to; null where it is another place.
    const auto local = [&](const Code& store) -> const Code* {
        const Code* place = defined[store.words[1]];
        while (place->op == spv::OpAccessChain) place = defined[place->words[3]];
        return place->op == spv::OpVariable && place->words[3] == spv::StorageClassFunction ? place : nullptr;
    };

    for (const Code& each : code) {
        if (each.named) defined[each.result()] = &each;
    }
    for (const Code& each : code) {
        if (each.op == spv::OpDecorate && each.words[2] == spv::DecorationBuiltIn &&
            each.words[3] == spv::BuiltInWorkgroupSize) {
            use(each.words[1]);
        }
        if (!each.acts() || each.is_about()) continue;
        const Code* variable = each.op == spv::OpStore ? local(each) : nullptr;
        if (each.op == spv::OpEntryPoint) {
            use(each.words[2]);
        } else if (variable) {
            stores[variable->result()].push_back(&each);
        } else {
            if (each.named) use(each.result());
            use_operands(each);
        }
    }
    while (!waiting.empty()) {
        const Word id = waiting.back();
        waiting.pop_back();
        use_operands(*defined[id]);
        const auto of = stores.find(id);
        if (of == stores.end()) continue;
        for (const Code* store : of->second) use_operands(*store);
    }

    Words out(spirv.begin(), spirv.begin() + spirv_header);
    for (const Code& each : code) {
        const Code* variable = each.op == spv::OpStore ? local(each) : nullptr;
        if ((each.named && !used[each.result()]) || (each.is_about() && !used[each.words[1]]) ||
            (variable && !used[variable->result()])) {
            continue;
        }
        const std::size_t at = out.size();
        for (std::size_t i = 0; i < each.words.size(); ++i) {
            const bool dropped = each.op == spv::OpEntryPoint && i > 0 && each.is_id(i) && !used[each.words[i]];
            if (!dropped) out.push_back(each.words[i]);
        }
        out[at] = first_word(each.op, out.size() - at);
    }
    return out;
}

}  // namespace

std::vector<std::uint32_t> folded(std::span<const std::uint32_t> spirv, const Specialization& constants) {
    const Words whole(spirv.begin(), spirv.end());
    Words words = whole;
    const auto code = code_of(words);
    if (!code) return whole;
    number_ids(words, *code);
    const auto reached = Propagation(words, *code, constants).run();
    if (!reached) return whole;
    words = without_dead_code(*reached);
    number_ids(words, *code_of(words));
    return words;
}

}  // namespace vkcppm
