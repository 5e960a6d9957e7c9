// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The stresses of a frame: written a beat of several taxels at a time, read taxel by taxel in any order.
//
// From taxel to stress: 2 enabled cycles.

`default_nettype none

module sptfra_frame_memory #(
    // Taxels of a frame, and of a beat: 2, 4 or 8
    parameter TAXELS = 100,
    parameter SAMPLES = 4,
    // Bits of a stress
    parameter WIDTH = 27,
    // Derived
    parameter BEATS = (TAXELS + SAMPLES - 1) / SAMPLES,
    parameter BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1,
    parameter SAMPLE_WIDTH = $clog2(SAMPLES)
) (
    input  wire clock,
    // Write
    input  wire write_enable,
    input  wire [BEAT_WIDTH-1:0] write_beat,
    input  wire [SAMPLES*WIDTH-1:0] write_stresses, // the beat's first taxel in the lowest bits
    // Read
    input  wire read_enable,
    input  wire [BEAT_WIDTH+SAMPLE_WIDTH-1:0] taxel,
    output reg  [WIDTH-1:0] stress
);

    wire [BEAT_WIDTH-1:0] read_beat = taxel[SAMPLE_WIDTH +: BEAT_WIDTH];
    wire [WIDTH-1:0] stress_of [0:SAMPLES-1];
    reg [SAMPLE_WIDTH-1:0] sample;
    genvar index;

    generate
        for (index = 0; index < SAMPLES; index = index + 1) begin : gen_samples
            sptfra_ram #(
                .WIDTH         (WIDTH),
                .DEPTH         (BEATS),
                .ADDRESS_WIDTH (BEAT_WIDTH)
            ) stresses (
                .clock         (clock),
                .write_enable  (write_enable),
                .write_address (write_beat),
                .write_data    (write_stresses[WIDTH*index +: WIDTH]),
                .read_enable   (read_enable),
                .read_address  (read_beat),
                .read_data     (stress_of[index])
            );
        end
    endgenerate

    always @(posedge clock) begin
        if (read_enable) begin
            sample <= taxel[SAMPLE_WIDTH-1:0];
            stress <= stress_of[sample];
        end
    end

endmodule

`default_nettype wire
