// SPDX-License-Identifier: MIT OR Apache-2.0
// The C interface between the stream driver and the simulated core: one call a clock cycle, everything in registers.
//
// Input word of dut_step: bits 32 s_axis_tvalid, 33 s_axis_tlast, 34 m_axis_tready, 35 aresetn. Output word: bits 15:0
// m_axis_tkeep, 32 m_axis_tvalid, 33 m_axis_tlast, 34 s_axis_tready, 63 the simulation failed. The data of both streams
// are arrays of four words of 32 bits, of which a beat has the first one, two or four.
//
// A core with a register bank takes what its AXI4-Lite port is driven with from dut_drive_control, before dut_step, and
// leaves what the port showed in that cycle to dut_read_control. Inputs: bits 11:0 and 27:16 of `addresses` awaddr and
// araddr, `data` wdata, `flags` 0 awvalid, 1 wvalid, 2 bready, 3 arvalid, 4 rready, 11:8 wstrb. Outputs: bits 31:0 rdata,
// 32 awready, 33 wready, 34 bvalid, 35 arready, 36 rvalid, 37 interrupt, 41:40 bresp, 43:42 rresp, 63 no such port.

#include "Vdut.h"
#include "verilated.h"
#if VM_TRACE_FST
#include "verilated_fst_c.h"
using Trace = VerilatedFstC;
#elif VM_TRACE_VCD
#include "verilated_vcd_c.h"
using Trace = VerilatedVcdC;
#elif VM_TRACE_SAIF
#include "verilated_saif_c.h"
using Trace = VerilatedSaifC;
#endif

#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#define DUT_API extern "C" __attribute__((visibility("default")))

// Verilator ends the process on $fatal, $stop and unreadable ROM files; here the caller gets a message.
void vl_fatal(const char* file, int line, const char*, const char* message) {
    throw std::runtime_error(std::string(file ? file : "") + ":" + std::to_string(line) + ": " + message);
}
void vl_stop(const char* file, int line, const char*) { vl_fatal(file, line, "", "$stop"); }
void vl_finish(const char* file, int line, const char*) { vl_fatal(file, line, "", "$finish"); }
void vl_warn(const char* file, int line, const char*, const char* message) { vl_fatal(file, line, "", message); }

namespace {

constexpr uint64_t FAILED = uint64_t(1) << 63;
constexpr uint64_t NO_CONTROL = uint64_t(1) << 63;

// The AXI4-Lite port, on a model that has one.
template <class Model, class = void>
struct Control {
    static void drive(Model&, uint32_t, uint32_t, uint32_t) {}
    static uint64_t read(Model&) { return NO_CONTROL; }
};

template <class Model>
struct Control<Model, std::void_t<decltype(std::declval<Model&>().s_axi_ctrl_awvalid)>> {
    static void drive(Model& model, uint32_t addresses, uint32_t data, uint32_t flags) {
        model.s_axi_ctrl_awaddr = addresses & 0xFFF;
        model.s_axi_ctrl_araddr = (addresses >> 16) & 0xFFF;
        model.s_axi_ctrl_awprot = 0;
        model.s_axi_ctrl_arprot = 0;
        model.s_axi_ctrl_wdata = data;
        model.s_axi_ctrl_awvalid = flags & 1;
        model.s_axi_ctrl_wvalid = (flags >> 1) & 1;
        model.s_axi_ctrl_bready = (flags >> 2) & 1;
        model.s_axi_ctrl_arvalid = (flags >> 3) & 1;
        model.s_axi_ctrl_rready = (flags >> 4) & 1;
        model.s_axi_ctrl_wstrb = (flags >> 8) & 0xF;
    }

    static uint64_t read(Model& model) {
        const auto bit = [](uint64_t value, int position) { return value << position; };
        // Verilator's name for a port whose own is a word of C++.
        const uint64_t interrupt = model.__SYM__interrupt;
        return uint64_t(model.s_axi_ctrl_rdata) | bit(model.s_axi_ctrl_awready, 32) | bit(model.s_axi_ctrl_wready, 33)
               | bit(model.s_axi_ctrl_bvalid, 34) | bit(model.s_axi_ctrl_arready, 35)
               | bit(model.s_axi_ctrl_rvalid, 36) | bit(interrupt, 37) | bit(model.s_axi_ctrl_bresp, 40)
               | bit(model.s_axi_ctrl_rresp, 42);
    }
};

// The data of a beat, on ports of each width.
constexpr uint32_t words_of(const IData&) { return 1; }
constexpr uint32_t words_of(const QData&) { return 2; }
template <std::size_t Words>
constexpr uint32_t words_of(const VlWide<Words>&) {
    return Words;
}
void put(IData& port, const uint32_t* words) { port = words[0]; }
void put(QData& port, const uint32_t* words) { port = words[0] | uint64_t(words[1]) << 32; }
template <std::size_t Words>
void put(VlWide<Words>& port, const uint32_t* words) {
    for (std::size_t word = 0; word < Words; ++word) port[word] = words[word];
}
void take(const IData& port, uint32_t* words) { words[0] = port; }
void take(const QData& port, uint32_t* words) {
    words[0] = uint32_t(port);
    words[1] = uint32_t(port >> 32);
}
template <std::size_t Words>
void take(const VlWide<Words>& port, uint32_t* words) {
    for (std::size_t word = 0; word < Words; ++word) words[word] = port[word];
}

// Which bytes of a beat out count: all, on a model that does not say.
template <class Model, class = void>
struct Keep {
    static uint64_t read(Model& model) { return (uint64_t(1) << (4 * words_of(model.m_axis_tdata))) - 1; }
};

template <class Model>
struct Keep<Model, std::void_t<decltype(std::declval<Model&>().m_axis_tkeep)>> {
    static uint64_t read(Model& model) { return model.m_axis_tkeep; }
};

struct Dut {
    VerilatedContext context;
    std::unique_ptr<Vdut> model;
#if VM_TRACE
    std::unique_ptr<Trace> trace;
#endif
    uint64_t time = 0;         // in a trace, ps
    uint64_t half_period = 1;  // of the clock, ps
    uint64_t control = NO_CONTROL;  // what the port showed in the last cycle

    explicit Dut(uint32_t seed) {
        context.randReset(2);  // registers start with random bits, the same ones for the same seed
        context.randSeed(int(seed));
        context.fatalOnError(true);
        model = std::make_unique<Vdut>(&context, "top");
        model->aclk = 0;
        model->aresetn = 0;
        model->s_axis_tvalid = 0;
        model->s_axis_tlast = 0;
        const uint32_t nothing[4] = {};
        put(model->s_axis_tdata, nothing);
        model->m_axis_tready = 0;
        Control<Vdut>::drive(*model, 0, 0, 0);
        model->eval();
    }

    ~Dut() {
        if (model) model->final();
#if VM_TRACE
        if (trace) trace->close();
#endif
    }

    void settle(int clock) {
        model->aclk = clock;
        model->eval();
#if VM_TRACE
        if (trace) trace->dump(time);
#endif
        time += half_period;
    }
};

void report(const char* message, char* text, size_t size) {
    if (size > 0) std::snprintf(text, size, "%s", message);
}

}  // namespace

// A core before its first clock edge; null and a message in `text` if a ROM file cannot be read.
DUT_API void* dut_new(uint32_t seed, char* text, size_t size) {
    try {
        return new Dut(seed);
    } catch (const std::exception& error) {
        report(error.what(), text, size);
        return nullptr;
    }
}

// 32-bit words of a beat, of either stream.
DUT_API uint32_t dut_words() { return sizeof(std::declval<Vdut&>().m_axis_tdata) / sizeof(uint32_t); }

DUT_API void dut_delete(void* handle) {
    try {
        delete static_cast<Dut*>(handle);
    } catch (const std::exception&) {
        // `final` blocks have nothing to say that matters once the run is over.
    }
}

// One clock cycle: apply the inputs, let them settle, read the outputs, then the rising edge.
DUT_API uint64_t dut_step(void* handle, uint64_t inputs, const uint32_t* data_in, uint32_t* data_out, char* text,
                          size_t size) {
    try {
        Dut& dut = *static_cast<Dut*>(handle);
        Vdut& model = *dut.model;
        put(model.s_axis_tdata, data_in);
        model.s_axis_tvalid = (inputs >> 32) & 1;
        model.s_axis_tlast = (inputs >> 33) & 1;
        model.m_axis_tready = (inputs >> 34) & 1;
        model.aresetn = (inputs >> 35) & 1;
        dut.settle(0);
        take(model.m_axis_tdata, data_out);
        const uint64_t outputs = Keep<Vdut>::read(model) | uint64_t(model.m_axis_tvalid) << 32
                                 | uint64_t(model.m_axis_tlast) << 33 | uint64_t(model.s_axis_tready) << 34;
        dut.control = Control<Vdut>::read(model);
        dut.settle(1);
        return outputs;
    } catch (const std::exception& error) {
        report(error.what(), text, size);
        return FAILED;
    }
}

// Drives the AXI4-Lite port from the next cycle on; nothing on a core without one.
DUT_API void dut_drive_control(void* handle, uint32_t addresses, uint32_t data, uint32_t flags) {
    Control<Vdut>::drive(*static_cast<Dut*>(handle)->model, addresses, data, flags);
}

// What the port showed in the last cycle.
DUT_API uint64_t dut_read_control(void* handle) { return static_cast<Dut*>(handle)->control; }

#if VM_TRACE
// Writes every signal to `path` from now on, at a clock with this half period in ps. False if the file cannot be created.
DUT_API int dut_trace(void* handle, const char* path, uint64_t half_period) {
    try {
        Dut& dut = *static_cast<Dut*>(handle);
        dut.half_period = half_period;
        dut.context.traceEverOn(true);
        dut.trace = std::make_unique<Trace>();
        dut.model->trace(dut.trace.get(), 99);
        dut.trace->open(path);
        return dut.trace->isOpen();
    } catch (const std::exception&) {
        return 0;
    }
}
#endif
