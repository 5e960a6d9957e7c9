// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Bz of a wide stream, for a folded grid: takes frames a beat of several samples a cycle, checks them, and writes them
// as fixed point, folded into parity classes, into one of two banks of the lanes' operand memories.
//
// Every sample of a beat has a conversion of its own; beats are kept, from where quads go to the lanes as soon as they
// are complete, and taxels one by one to CeAn, beside the lanes' work. Beat to stress: 5 cycles, with counts 9, with a
// curve more; then to the write of a quad 5, to CeAn 3. What fills a frame's last beat behind its samples is ignored.
// A frame is accepted while a bank is free and CeAn has finished the frame before. Frames of a wrong length are
// swallowed up to their TLAST and marked.

`default_nettype none

module sptfra_bz_wide #(
    // Bits of a beat
    parameter STREAM_BITS = 128,
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of a stress, 27 at most, and of what the lanes read: as many, or 29 and more
    parameter DATA_BITS = 27,
    // What a sample is: 0 float32, 1 and 2 integers; and how it becomes a stress: see sptfra_samples
    parameter SAMPLE = 0,
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    parameter COUNTS = 0,
    parameter PER_TAXEL = 0,
    parameter signed [9:0] EXPONENT = 10'sd0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    parameter integer COUNT_SHIFT = 16,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter CURVE_LEVELS = 0,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b1}},
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Prefix of the ROM file names, and what they begin with; those of taxels have _sampleN behind that, N from 0 on
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Cycles from a beat to its stress that the plan counts on; 0: any
    parameter EXPECTED_STAGES = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter ELEMENTS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // Stream in
    input  wire [STREAM_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Operand memories, class 0 in the lowest bits
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [4*DATA_BITS-1:0] write_data,
    // To CeAn: each stress, then the frame's flags
    input  wire cean_idle,
    input  wire direction_room, // in CeAn, for another frame
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced, // none
    // Banks
    output wire frame_ready, // a whole frame waits
    input  wire frame_start, // the lanes begin with it
    input  wire frame_release // its bank is free again
);

    localparam TAXELS = COLUMNS * ROWS;
    localparam SAMPLES = STREAM_BITS / SAMPLE_BITS;
    localparam SAMPLE_WIDTH = $clog2(SAMPLES);
    localparam BEATS = (TAXELS + SAMPLES - 1) / SAMPLES;
    localparam BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1;
    localparam COUNT_WIDTH = $clog2(BEATS + 1);
    localparam INDEX_WIDTH = BEAT_WIDTH + SAMPLE_WIDTH;
    localparam REST = TAXELS - (BEATS - 1) * SAMPLES; // samples of the last beat
    localparam [31:0] LAST_BEAT_WIDE = BEATS - 1;
    localparam [COUNT_WIDTH-1:0] LAST_BEAT = LAST_BEAT_WIDE[COUNT_WIDTH-1:0];
    localparam STRESS_BITS = (DATA_BITS < 27) ? DATA_BITS : 27;
    localparam LEVELS = (CURVE_LEVELS != 0) ? CURVE_LEVELS : 1;
    localparam NUMBER_STAGES = 5;
    localparam VALUE_STAGES = NUMBER_STAGES + ((CURVE_LEVELS != 0) ? CURVE_LEVELS + 7 : (PER_TAXEL != 0) ? 2 : 0);
    localparam STAGES = VALUE_STAGES + ((COUNTS == 0) ? 0 : (CURVE_LEVELS != 0) ? 7 : 4);

    generate
        if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
            sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
        end
        if ((DATA_BITS < 16) || (DATA_BITS > 35)) begin : gen_check_data
            sptfra_error_data_bits_must_be_16_to_35 invalid ();
        end
        if ((SAMPLES != 2) && (SAMPLES != 4) && (SAMPLES != 8)) begin : gen_check_samples
            sptfra_error_samples_of_a_beat_must_be_2_4_or_8 invalid ();
        end
        if ((EXPECTED_STAGES != 0) && (EXPECTED_STAGES != STAGES)) begin : gen_check_stages
            sptfra_error_the_plan_counts_on_other_stages invalid ();
        end
    endgenerate

    // ---- Frames, one at a time in the pipeline
    reg ended; // the frame's last beat is there, and not all that is made of it
    reg [1:0] banks_taken;
    wire accept, frame_opens, in_frame, under_way, arrives, arrives_bad_length;
    wire [STAGES:0] takes;
    wire [STAGES:0] ends;

    sptfra_frame_gate #(
        .BEATS  (BEATS),
        .STAGES (STAGES)
    ) gate (
        .clock          (clock),
        .reset          (reset),
        .s_tlast        (s_tlast),
        .s_tvalid       (s_tvalid),
        .s_tready       (s_tready),
        .room           (!ended && cean_idle && (banks_taken != 2'd2) && direction_room),
        .advance        (1'b1),
        .accept         (accept),
        .opens          (frame_opens),
        .in_frame       (in_frame),
        .under_way      (under_way),
        .takes          (takes),
        .ends           (ends),
        .out_valid      (arrives),
        .out_bad_length (arrives_bad_length)
    );

    // ---- Samples to stress
    wire [27*SAMPLES-1:0] stresses;
    wire [STRESS_BITS*SAMPLES-1:0] narrow_stresses;
    wire [SAMPLES-1:0] saturated;
    wire [SAMPLES-1:0] not_finite;
    genvar sample;

    generate
        for (sample = 0; sample < SAMPLES; sample = sample + 1) begin : gen_samples
            localparam [7:0] DIGIT = 48 + sample;
            wire signed [26:0] fixed;
            wire [LEVELS-1:0] segment;
            wire [BEAT_WIDTH-1:0] exponent_beat, gain_beat;

            sptfra_samples #(
                .TAXELS       (BEATS),
                .SAMPLE       (SAMPLE),
                .NUMBER_SHIFT (NUMBER_SHIFT),
                .NUMBER_BOUND (NUMBER_BOUND),
                .COUNTS       (COUNTS),
                .PER_TAXEL    (PER_TAXEL),
                .EXPONENT     (EXPONENT),
                .GAIN         (GAIN),
                .OFFSET_BITS  (OFFSET_BITS),
                .COUNT_SHIFT  (COUNT_SHIFT),
                .FULL_SCALE   (FULL_SCALE),
                .CURVE_LEVELS (CURVE_LEVELS),
                .CURVE_KNOTS  (CURVE_KNOTS),
                .CURVE_LAST   (CURVE_LAST),
                .STRESS_BOUND (STRESS_BOUND),
                .ROM_DIR      (ROM_DIR),
                .ROM_NAME     (ROM_NAME),
                .TAXEL_NAME   ((ROM_NAME == "") ? "" : {ROM_NAME, "_sample", DIGIT})
            ) samples (
                .clock          (clock),
                .reset          (reset),
                .advance        (1'b1),
                .sample         (s_tdata[SAMPLE_BITS*sample +: SAMPLE_BITS]),
                .sample_taken   (takes[0]),
                .sample_ends    (ends[0]),
                .value_taken    (takes[VALUE_STAGES]),
                .value_ends     (ends[VALUE_STAGES]),
                .exponent_taxel (exponent_beat),
                .gain_taxel     (gain_beat),
                .bank_exponent  (10'd0),
                .bank_gain      (18'd0),
                .bank_offset    ({OFFSET_BITS{1'b0}}),
                .bank_knots     ({27*(1<<LEVELS){1'b0}}),
                .bank_segments  (7'd0),
                .bank_last      (27'sd0),
                .bank_reach     (27'd0),
                .segment        (segment),
                .bank_line      (78'd0),
                .stress         (fixed),
                .saturated      (saturated[sample]),
                .not_finite     (not_finite[sample])
            );

            wire _unused_banks = &{1'b0, segment, exponent_beat, gain_beat};
            assign stresses[27*sample +: 27] = fixed;
            assign narrow_stresses[STRESS_BITS*sample +: STRESS_BITS] = fixed[STRESS_BITS-1:0];
        end
    endgenerate

    // ---- The frame as it comes
    localparam [31:0] REST_MASK = (1 << REST) - 1;
    reg [COUNT_WIDTH-1:0] written; // beats that are there
    reg bad_length;
    reg seen_saturated;
    reg seen_not_finite;
    wire beat_valid = takes[STAGES];
    wire [SAMPLES-1:0] counts = (written == LAST_BEAT) ? REST_MASK[SAMPLES-1:0] : {SAMPLES{1'b1}};
    wire [31:0] written_wide = {{(32-COUNT_WIDTH){1'b0}}, written};
    wire over; // all is made of the frame

    always @(posedge clock) begin
        if (beat_valid) begin
            written <= written + 1'b1;
            seen_saturated <= seen_saturated || ((saturated & counts) != {SAMPLES{1'b0}});
            seen_not_finite <= seen_not_finite || ((not_finite & counts) != {SAMPLES{1'b0}});
        end
        if (ends[STAGES]) begin
            ended <= 1'b1;
            bad_length <= arrives_bad_length;
        end
        if (reset || over) begin
            written <= {COUNT_WIDTH{1'b0}};
            ended <= 1'b0;
            seen_saturated <= 1'b0;
            seen_not_finite <= 1'b0;
        end
    end

    // ---- To the lanes, quad by quad
    wire folded;
    wire frame_written; // the frame is complete

    sptfra_fold_frame #(
        .COLUMNS     (COLUMNS),
        .ROWS        (ROWS),
        .SAMPLES     (SAMPLES),
        .STRESS_BITS (STRESS_BITS),
        .DATA_BITS   (DATA_BITS)
    ) fold (
        .clock         (clock),
        .reset         (reset),
        .advance       (write_ready), // whether or not there is something to write
        .beat_valid    (beat_valid),
        .beat          (written_wide[BEAT_WIDTH-1:0]),
        .stresses      (narrow_stresses),
        .written       (written),
        .ended         (ended),
        .folded        (folded),
        .restart       (over),
        .write_valid   (write_valid),
        .write_bank    (write_bank),
        .write_quad    (write_row),
        .write_data    (write_data),
        .frame_written (frame_written)
    );

    // ---- To CeAn, taxel by taxel
    localparam [31:0] LAST_WIDE = TAXELS - 1;
    reg [INDEX_WIDTH-1:0] taxel;
    reg all_told;
    localparam TURN_TO_STRESS = 2; // of the memory
    reg [TURN_TO_STRESS:1] told;
    reg [TURN_TO_STRESS:1] told_last;
    reg cean_done; // it has the frame's flags
    wire last_taxel = (taxel == LAST_WIDE[INDEX_WIDTH-1:0]);
    wire [31:0] beat_needed = {{(32-BEAT_WIDTH){1'b0}}, taxel[SAMPLE_WIDTH +: BEAT_WIDTH]};
    wire there = ended || (!last_taxel && (beat_needed < written_wide));
    wire tell = there && !all_told;
    wire [26:0] stress_told;

    assign stress_valid = told[2];
    assign stress = $signed(stress_told);
    assign frame_done = told_last[2];
    assign frame_saturated = seen_saturated;
    assign frame_not_finite = seen_not_finite;
    assign frame_bad_length = bad_length;
    assign frame_replaced = 30'd0;
    assign over = folded && (frame_done || cean_done);

    sptfra_frame_memory #(
        .TAXELS  (TAXELS),
        .SAMPLES (SAMPLES),
        .WIDTH   (27)
    ) frame (
        .clock          (clock),
        .write_enable   (beat_valid),
        .write_beat     (written_wide[BEAT_WIDTH-1:0]),
        .write_stresses (stresses),
        .read_enable    (1'b1),
        .taxel          (taxel),
        .stress         (stress_told)
    );

    always @(posedge clock) begin
        told <= {told[1], tell};
        told_last <= {told_last[1], tell && last_taxel};
        if (tell) begin
            taxel <= taxel + 1'b1;
            all_told <= last_taxel;
        end
        if (frame_done) begin
            cean_done <= 1'b1;
        end
        if (reset || over) begin
            taxel <= {INDEX_WIDTH{1'b0}};
            all_told <= 1'b0;
            cean_done <= 1'b0;
        end
        if (reset) begin
            told <= 2'd0;
            told_last <= 2'd0;
        end
    end

    // ---- Banks
    reg [1:0] frames_waiting;

    assign frame_ready = (frames_waiting != 2'd0);

    always @(posedge clock) begin
        banks_taken <= banks_taken + {1'b0, frame_opens} - {1'b0, frame_release};
        frames_waiting <= frames_waiting + {1'b0, frame_written} - {1'b0, frame_start};
        if (reset) begin
            banks_taken <= 2'd0;
            frames_waiting <= 2'd0;
        end
    end

    wire _unused = &{1'b0, written_wide, accept, arrives, in_frame, under_way};

endmodule

`default_nettype wire
