#include "vk/texels.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "core/error.h"
#include "vk/binding.h"
#include "vk/spirv.h"

namespace vkcppm {
namespace {

using Word = std::uint32_t;
using Words = std::vector<Word>;

void add(Words& to, spv::Op op, std::initializer_list<Word> operands) {
    to.push_back(first_word(op, operands.size() + 1));
    to.insert(to.end(), operands);
}

bool is_binding(Instruction words) { return opcode(words) == spv::OpDecorate && words[2] == spv::DecorationBinding; }

/// Goes through a module once to learn what it declares, and once to write it.
class Rewriting {
public:
    Rewriting(std::span<const Word> spirv, const std::vector<Code>& code)
        : spirv_(spirv), code_(code), bound_(spirv[spirv_bound]) {}

    Words run() {
        read();
        for (auto& [id, texels] : texels_) declare(id, texels);
        Words out(spirv_.begin(), spirv_.begin() + spirv_header);
        bool annotations_end = false, functions = false;
        for (const Code& code : code_) {
            // Annotations stand before types, and these before functions.
            if (!annotations_end && code.named && code.op != spv::OpExtInstImport) {
                out.insert(out.end(), annotations_.begin(), annotations_.end());
                annotations_end = true;
            }
            if (!functions && code.op == spv::OpFunction) {
                out.insert(out.end(), globals_.begin(), globals_.end());
                functions = true;
            }
            write(out, code);
        }
        out[spirv_bound] = bound_;
        return out;
    }

private:
    /// A variable that is a texel buffer.
    struct Texels {
        Word row = 0;         // binding of the buffer itself
        Word vector = 0;      // type of what is fetched: four words
        Word element = 0;     // type of what is loaded: the same, or a word where texels are of one
        Word at_element = 0;  // type of the pointer to it
    };

    void read() {
        std::map<Word, Word> bindings;
        std::unordered_map<Word, const Code*> types;
        for (const Code& code : code_) {
            if (is_binding(code.words)) bindings[code.words[1]] = code.words[3];
            if (code.op == spv::OpFunction) break;
            if (code.named) types[code.result()] = &code;
            if (code.op == spv::OpTypeInt) integer_ = code.result();
        }
        const auto vector_of = [&](Word component) {
            for (const auto& [id, type] : types) {
                if (type->op == spv::OpTypeVector && type->words[2] == component && type->words[3] == 4) return id;
            }
            throw Error(ExitCode::internal, "a kernel has texels and no type of four words");
        };
        for (const auto& [id, binding] : bindings) {
            if (binding < TEXELS_BINDING) continue;
            const Code& pointer = *types.at(types.at(id)->type());
            const Code& image = *types.at(types.at(pointer.words[3])->words[2]);  // of what is sampled
            const Word component = image.words[2];
            Texels texels{.row = binding - TEXELS_BINDING, .vector = vector_of(component)};
            const bool words = texel_bytes(bound_buffer(Binding(texels.row)).access) == sizeof(Word);
            texels.element = words ? component : texels.vector;
            texels_[id] = texels;
        }
        // What is loaded of them, which nothing but a fetch uses.
        for (const Code& code : code_) {
            const bool loads = code.op == spv::OpLoad && texels_.contains(code.words[3]);
            const bool unwraps = code.op == spv::OpImage && images_.contains(code.words[3]);
            if (loads) images_[code.result()] = code.words[3];
            if (unwraps) images_[code.result()] = images_[code.words[3]];
        }
        for (const auto& [id, texels] : texels_) rows_.insert(texels.row);
        // Kernels that write a buffer and read its texels now do both by one binding.
        for (const auto& [id, binding] : bindings) {
            if (rows_.contains(binding)) alias(id);
        }
    }

    void alias(Word variable) { add(annotations_, spv::OpDecorate, {variable, spv::DecorationAliased}); }

    /// Types, shared by all of an element, and the variable.
    void declare(Word id, Texels& texels) {
        auto& [at_block, at_element] = pointers_[texels.element];
        if (at_block == 0) {
            const Word array = bound_++, block = bound_++;
            at_block = bound_++;
            at_element = bound_++;
            if (zero_ == 0) {
                zero_ = bound_++;
                add(globals_, spv::OpConstant, {integer_, zero_, 0});
            }
            const Word stride = texels.element == texels.vector ? 16 : 4;
            add(annotations_, spv::OpDecorate, {array, spv::DecorationArrayStride, stride});
            add(annotations_, spv::OpDecorate, {block, spv::DecorationBlock});
            add(annotations_, spv::OpMemberDecorate, {block, 0, spv::DecorationOffset, 0});
            add(annotations_, spv::OpMemberDecorate, {block, 0, spv::DecorationNonWritable});
            add(globals_, spv::OpTypeRuntimeArray, {array, texels.element});
            add(globals_, spv::OpTypeStruct, {block, array});
            add(globals_, spv::OpTypePointer, {at_block, spv::StorageClassStorageBuffer, block});
            add(globals_, spv::OpTypePointer, {at_element, spv::StorageClassStorageBuffer, texels.element});
        }
        texels.at_element = at_element;
        add(globals_, spv::OpVariable, {at_block, id, spv::StorageClassStorageBuffer});
        alias(id);
    }

    void write(Words& out, const Code& code) {
        const Word result = code.result();
        if (texels_.contains(result) || images_.contains(result)) return;
        if (code.is_about() && images_.contains(code.words[1])) return;
        if (is_binding(code.words) && texels_.contains(code.words[1])) {
            add(out, spv::OpDecorate, {code.words[1], spv::DecorationBinding, texels_.at(code.words[1]).row});
        } else if (code.op == spv::OpImageFetch) {
            const Word variable = images_.at(code.words[3]), coordinate = code.words[4];
            const Texels& texels = texels_.at(variable);
            const Word pointer = bound_++;
            add(out, spv::OpAccessChain, {texels.at_element, pointer, variable, zero_, coordinate});
            if (texels.element == texels.vector) {
                add(out, spv::OpLoad, {texels.vector, result, pointer});
            } else {  // the first component is what kernels read of such a texel
                const Word word = bound_++;
                add(out, spv::OpLoad, {texels.element, word, pointer});
                add(out, spv::OpCompositeConstruct, {texels.vector, result, word, word, word, word});
            }
        } else {
            out.insert(out.end(), code.words.begin(), code.words.end());
        }
    }

    std::span<const Word> spirv_;
    const std::vector<Code>& code_;
    Word bound_;
    Word integer_ = 0, zero_ = 0;                     // a type of integers, and its 0
    std::map<Word, Texels> texels_;                   // by the variable
    std::set<Word> rows_;                             // of those
    std::unordered_map<Word, Word> images_;           // the variable, by what is loaded of it
    std::map<Word, std::pair<Word, Word>> pointers_;  // to the block and its element, by the type of the element
    Words annotations_, globals_;
};

}  // namespace

std::vector<std::uint32_t> bindings_of(std::span<const std::uint32_t> spirv) {
    std::set<std::uint32_t> found;
    for (const Instruction words : instructions_of(spirv)) {
        if (is_binding(words)) found.insert(words[3]);
    }
    return {found.begin(), found.end()};
}

std::vector<std::uint32_t> with_storage_for_texels(std::span<const std::uint32_t> spirv) {
    const auto is_texels = [](std::uint32_t binding) { return binding >= TEXELS_BINDING; };
    if (std::ranges::none_of(bindings_of(spirv), is_texels)) return {spirv.begin(), spirv.end()};
    const auto code = code_of(spirv);
    if (!code) throw Error(ExitCode::internal, "a kernel holds an instruction of which nothing is known");
    return Rewriting(spirv, *code).run();
}

}  // namespace vkcppm
