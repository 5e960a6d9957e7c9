// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame memory: stresses of a part of a frame, written a beat at a time, read taxel by taxel in any order.
//
// From taxel to stress: 2 enabled cycles.

`default_nettype none

module sptfra_frame_memory #(
    // Taxels of a beat: 1, 2, 4 or 8; beats of a frame
    parameter SAMPLES = 1,
    parameter BEATS = 100,
    // Beats that are kept: the first of them, and how many
    parameter FIRST = 0,
    parameter KEPT = BEATS,
    // Bits of a stress
    parameter WIDTH = 27,
    // Derived
    parameter BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1,
    parameter INDEX_WIDTH = BEAT_WIDTH + $clog2(SAMPLES)
) (
    input  wire clock,
    // Write
    input  wire write_enable,
    input  wire [BEAT_WIDTH-1:0] write_beat, // of the frame
    input  wire [SAMPLES*WIDTH-1:0] write_stresses, // the beat's first taxel in the lowest bits
    // Read
    input  wire read_enable,
    input  wire [INDEX_WIDTH-1:0] taxel, // the first one that is kept is 0
    output reg  [WIDTH-1:0] stress
);

    localparam SAMPLE_WIDTH = $clog2(SAMPLES);
    localparam ADDRESS_WIDTH = (KEPT > 2) ? $clog2(KEPT) : 1;
    localparam [31:0] FIRST_WIDE = FIRST;
    localparam [31:0] KEPT_WIDE = KEPT;
    wire [31:0] write_wide = {{(32-BEAT_WIDTH){1'b0}}, write_beat} - FIRST_WIDE;
    wire [SAMPLES*WIDTH-1:0] beat_1;
    genvar index;

    for (index = 0; index < SAMPLES; index = index + 1) begin : gen_samples
        sptfra_ram #(
            .WIDTH         (WIDTH),
            .DEPTH         (KEPT),
            .ADDRESS_WIDTH (ADDRESS_WIDTH)
        ) stresses (
            .clock         (clock),
            .write_enable  (write_enable && (write_wide < KEPT_WIDE)),
            .write_address (write_wide[ADDRESS_WIDTH-1:0]),
            .write_data    (write_stresses[WIDTH*index +: WIDTH]),
            .read_enable   (read_enable),
            .read_address  (taxel[SAMPLE_WIDTH +: ADDRESS_WIDTH]),
            .read_data     (beat_1[WIDTH*index +: WIDTH])
        );
    end
    if (SAMPLES == 1) begin : gen_single
        always @(posedge clock) begin
            if (read_enable) begin
                stress <= beat_1;
            end
        end
    end else begin : gen_sample
        reg [SAMPLE_WIDTH-1:0] sample_1;

        always @(posedge clock) begin
            if (read_enable) begin
                sample_1 <= taxel[SAMPLE_WIDTH-1:0];
                stress <= beat_1[WIDTH*sample_1 +: WIDTH];
            end
        end
    end

    wire _unused = &{1'b0, write_wide, taxel};

endmodule

`default_nettype wire
