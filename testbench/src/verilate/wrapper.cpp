// The C interface between the stream driver and the simulated core: one call a clock cycle, everything in registers.
//
// Input word of dut_step: bits 31:0 s_axis_tdata, 32 s_axis_tvalid, 33 s_axis_tlast, 34 m_axis_tready, 35 aresetn.
// Output word: bits 31:0 m_axis_tdata, 32 m_axis_tvalid, 33 m_axis_tlast, 34 s_axis_tready, 63 the simulation failed.

#include "Vdut.h"
#include "verilated.h"
#if VM_TRACE_FST
#include "verilated_fst_c.h"
using Trace = VerilatedFstC;
#elif VM_TRACE_VCD
#include "verilated_vcd_c.h"
using Trace = VerilatedVcdC;
#endif

#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

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
constexpr uint64_t HALF_PERIOD = 1;

struct Dut {
    VerilatedContext context;
    std::unique_ptr<Vdut> model;
#if VM_TRACE
    std::unique_ptr<Trace> trace;
#endif
    uint64_t time = 0;

    explicit Dut(uint32_t seed) {
        context.randReset(2);  // registers start with random bits, the same ones for the same seed
        context.randSeed(int(seed));
        context.fatalOnError(true);
        model = std::make_unique<Vdut>(&context, "top");
        model->aclk = 0;
        model->aresetn = 0;
        model->s_axis_tvalid = 0;
        model->s_axis_tlast = 0;
        model->s_axis_tdata = 0;
        model->m_axis_tready = 0;
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
        time += HALF_PERIOD;
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

DUT_API void dut_delete(void* handle) {
    try {
        delete static_cast<Dut*>(handle);
    } catch (const std::exception&) {
        // `final` blocks have nothing to say that matters once the run is over.
    }
}

// One clock cycle: apply the inputs, let them settle, read the outputs, then the rising edge.
DUT_API uint64_t dut_step(void* handle, uint64_t inputs, char* text, size_t size) {
    try {
        Dut& dut = *static_cast<Dut*>(handle);
        Vdut& model = *dut.model;
        model.s_axis_tdata = uint32_t(inputs);
        model.s_axis_tvalid = (inputs >> 32) & 1;
        model.s_axis_tlast = (inputs >> 33) & 1;
        model.m_axis_tready = (inputs >> 34) & 1;
        model.aresetn = (inputs >> 35) & 1;
        dut.settle(0);
        const uint64_t outputs = uint64_t(model.m_axis_tdata) | uint64_t(model.m_axis_tvalid) << 32
                                 | uint64_t(model.m_axis_tlast) << 33 | uint64_t(model.s_axis_tready) << 34;
        dut.settle(1);
        return outputs;
    } catch (const std::exception& error) {
        report(error.what(), text, size);
        return FAILED;
    }
}

#if VM_TRACE
// Writes every signal to `path` from now on. False if the file cannot be created.
DUT_API int dut_trace(void* handle, const char* path) {
    try {
        Dut& dut = *static_cast<Dut*>(handle);
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
