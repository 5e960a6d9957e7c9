// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Taxel stream: the beats of a frame as its taxels, one a cycle.
//
// A beat of one taxel passes in the same cycle. Of several, and with KEPT, the frame is kept; a taxel follows its turn
// by 2 cycles.

`default_nettype none

module sptfra_taxel_stream #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Taxels of a beat: 1, 2, 4 or 8
    parameter SAMPLES = 1,
    // 1: taxels wait for the whole frame
    parameter KEPT = 0,
    // Bits of a taxel
    parameter WIDTH = 27,
    // Derived
    parameter BEATS = (TAXELS + SAMPLES - 1) / SAMPLES,
    parameter COUNT_WIDTH = $clog2(BEATS + 1)
) (
    input  wire clock,
    input  wire reset,
    // Beats
    input  wire takes,
    input  wire [COUNT_WIDTH-1:0] beat, // which it is
    input  wire [WIDTH*SAMPLES-1:0] stresses,
    input  wire ends, // the frame ends, with its last beat or after it
    input  wire whole, // all taxels may be read
    input  wire restart, // with the next frame
    // Taxels
    output wire stress_valid,
    output wire [WIDTH-1:0] stress,
    output wire done // the last one, or the end of a frame that is too short
);

    localparam BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1;
    wire [31:0] beat_wide = {{(32-COUNT_WIDTH){1'b0}}, beat};

    if ((SAMPLES == 1) && (KEPT == 0)) begin : gen_at_once
        assign stress_valid = takes;
        assign stress = stresses;
        assign done = ends;
        wire _unused_state = &{1'b0, clock, reset, whole, restart};
    end else begin : gen_one_by_one
        localparam SAMPLE_WIDTH = $clog2(SAMPLES);
        localparam INDEX_WIDTH = BEAT_WIDTH + SAMPLE_WIDTH;
        localparam [31:0] LAST_WIDE = TAXELS - 1;
        localparam READ_TO_STRESS = 2; // of the memory
        reg [INDEX_WIDTH-1:0] taxel;
        reg all_shown;
        reg [READ_TO_STRESS:1] shows;
        reg [READ_TO_STRESS:1] shows_last;
        wire last_taxel = (taxel == LAST_WIDE[INDEX_WIDTH-1:0]);
        wire [31:0] beat_needed = {{(32-BEAT_WIDTH){1'b0}}, taxel[SAMPLE_WIDTH +: BEAT_WIDTH]};
        wire show = (whole || ((KEPT == 0) && !last_taxel && (beat_needed < beat_wide))) && !all_shown;
        wire [WIDTH-1:0] kept;

        assign stress_valid = shows[READ_TO_STRESS];
        assign stress = kept;
        assign done = shows_last[READ_TO_STRESS];

        sptfra_frame_memory #(
            .SAMPLES (SAMPLES),
            .BEATS   (BEATS),
            .WIDTH   (WIDTH)
        ) frame (
            .clock          (clock),
            .write_enable   (takes),
            .write_beat     (beat_wide[BEAT_WIDTH-1:0]),
            .write_stresses (stresses),
            .read_enable    (1'b1),
            .taxel          (taxel),
            .stress         (kept)
        );

        always @(posedge clock) begin
            shows <= {shows[1], show};
            shows_last <= {shows_last[1], show && last_taxel};
            if (show) begin
                taxel <= taxel + 1'b1;
                all_shown <= last_taxel;
            end
            if (reset || restart) begin
                taxel <= {INDEX_WIDTH{1'b0}};
                all_shown <= 1'b0;
            end
            if (reset) begin
                shows <= 2'd0;
                shows_last <= 2'd0;
            end
        end

        wire _unused_ends = &{1'b0, ends};
    end

    wire _unused = &{1'b0, beat_wide};

endmodule

`default_nettype wire
