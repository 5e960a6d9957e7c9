// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Bz: takes frames of stresses or counts from the stream, checks them, and writes them to the lanes' operand memories.
//
// Beat to stress: as of sptfra_samples, a beat a cycle; what fills a frame's last beat behind its samples is ignored.
// A frame is accepted while one of two banks is free and CeAn has finished the frame before. Frames of a wrong length
// are swallowed up to their TLAST and marked. Calibration bank and smoothing are those at a frame's first beat.

`default_nettype none

module sptfra_bz #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Samples of a beat: 1, 2, 4 or 8; one where a frame is corrected or CALIBRATED
    parameter SAMPLES = 1,
    // As of sptfra_frame_writer
    parameter CHANNELS = 4,
    parameter DATA_BITS = 27,
    parameter SCALED = 0,
    // As of sptfra_samples; the last two as of sptfra_banks
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    parameter SAMPLE = 0,
    parameter COUNTS = 0,
    parameter CALIBRATED = 0,
    parameter PER_TAXEL = 0,
    parameter signed [9:0] EXPONENT = 10'sd0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    parameter integer COUNT_SHIFT = 16,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    parameter CURVE_LEVELS = 0,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b1}},
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    parameter [6:0] CURVE_COUNT = 7'd1,
    parameter signed [26:0] CURVE_LAST_VALUE = 27'sd0,
    // Dead taxels: see sptfra_replace; with MAPPED the others are the content of the banks at power-up
    parameter REPLACEABLE = 0,
    parameter MAPPED = 0,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)+15:0] REPLACED = 0,
    // Crosstalk, creep: see sptfra_frame_corrections. Smoothing: see sptfra_frame_writer
    parameter [59:0] CROSSTALK = 60'd0,
    parameter [45:0] CREEP = 46'd0,
    parameter [49:0] SMOOTHING = 50'd0,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Cycles from a beat to its stress that the plan counts on; 0: any
    parameter EXPECTED_STAGES = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter ELEMENTS = (CHANNELS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter TAXELS = COLUMNS * ROWS,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter HAS_MORE = ((MAPPED != 0) || (CURVE_LEVELS != 0)) ? 1 : 0,
    parameter COMMAND_BITS = (CALIBRATED == 0) ? 1 : TAXEL_WIDTH + OFFSET_BITS + 31 + 56 * HAS_MORE,
    parameter WORDS_BITS = (CALIBRATED == 0) ? 1 : OFFSET_BITS + 28 + 34 * HAS_MORE
) (
    input  wire clock,
    input  wire reset,
    // Stream in
    input  wire [SAMPLES*SAMPLE_BITS-1:0] s_tdata, // the first sample in the lowest bits
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Operand memories, component 0 in the lowest bits
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [CHANNELS*DATA_BITS-1:0] write_data,
    // To CeAn: each stress, then the frame's flags
    input  wire cean_idle,
    input  wire direction_room, // in CeAn, for another frame
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced, // sum of the magnitudes that took a dead taxel's place
    // The frame's power of two, for one cycle, before it is ready
    output wire scaled,
    output wire [4:0] exponent,
    output wire [25:0] smoothed, // {one cycle, variance}: see sptfra_smoothing
    // Banks
    output wire frame_ready, // a whole frame waits
    input  wire frame_start, // the lanes begin with it
    input  wire frame_release, // its bank is free again
    input  wire [3:0] smoothing, // see sptfra_smoothing
    // Calibration: {active bank, version, contact, noise}; a frame inside began with the other bank
    input  wire [67:0] active_calibration,
    output wire calibration_old_in_use,
    input  wire [COMMAND_BITS-1:0] bank_command, // as of sptfra_banks
    output wire [WORDS_BITS-1:0] bank_words,
    // {run, log2 of frames, taxel}; {finished, restless, bad frame, mean}
    input  wire [TAXEL_WIDTH+4:0] tare_command,
    output wire [29:0] tare_result,
    // What a frame begins with: see sptfra_frame_context
    output wire frame_calibrates,
    output wire [70:0] frame_calibration // {contact, noise, version, replaced taxels}
);

    localparam BEATS = (TAXELS + SAMPLES - 1) / SAMPLES;
    localparam BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1;
    localparam LEVELS = (CURVE_LEVELS != 0) ? CURVE_LEVELS : 1;
    localparam PLACES = (REPLACEABLE != 0) ? REPLACEABLE : 1;
    localparam NUMBER_STAGES = 5;
    localparam VALUE_STAGES = NUMBER_STAGES + ((CURVE_LEVELS != 0) ? CURVE_LEVELS + 7 : (PER_TAXEL != 0) ? 2 : 0);
    localparam STAGES = VALUE_STAGES + ((COUNTS == 0) ? 0 : (CURVE_LEVELS != 0) ? 7 : 4);

    if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
        sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
    end
    if ((SAMPLES != 1) && ((REPLACEABLE | CALIBRATED) != 0 || {CROSSTALK, CREEP} != 0)) begin : gen_check
        sptfra_error_samples_go_one_by_one_where_frames_are_corrected_or_calibrated invalid ();
    end
    if ((EXPECTED_STAGES != 0) && (EXPECTED_STAGES != STAGES)) begin : gen_check_stages
        sptfra_error_the_plan_counts_on_other_stages invalid ();
    end

    // ---- Frames, one at a time in the pipeline
    wire accept, opens, in_frame, under_way, out_valid, out_bad_length, bank_free, replace_busy, writer_busy;
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
        .room           (!replace_busy && !writer_busy && cean_idle && bank_free && direction_room),
        .accept         (accept),
        .opens          (opens),
        .in_frame       (in_frame),
        .under_way      (under_way),
        .takes          (takes),
        .ends           (ends),
        .out_valid      (out_valid),
        .out_bad_length (out_bad_length)
    );

    // ---- The calibration bank of the frame
    reg bank_held;
    wire active = active_calibration[67];
    wire bank = in_frame ? bank_held : active;

    assign frame_calibrates = opens;
    assign calibration_old_in_use = (in_frame || under_way || replace_busy) && (bank_held != active);

    always @(posedge clock) begin
        if (accept) begin
            bank_held <= bank;
        end
        if (reset) begin
            bank_held <= 1'b0;
        end
    end

    // Taxel of two stages before the stress
    reg [TAXEL_WIDTH-1:0] taxel_ahead;

    always @(posedge clock) begin
        if (takes[STAGES-2]) begin
            taxel_ahead <= taxel_ahead + 1'b1;
        end
        if (reset || ends[STAGES-2]) begin
            taxel_ahead <= {TAXEL_WIDTH{1'b0}};
        end
    end

    // ---- Samples to stress
    wire [BEAT_WIDTH*SAMPLES-1:0] exponent_taxels, gain_taxels; // those of sample 0 are for the banks
    wire [OFFSET_BITS+27:0] constants;
    wire [27*(1<<LEVELS)+60:0] curve;
    wire [LEVELS*SAMPLES-1:0] segment;
    wire [77:0] line;
    wire [27*SAMPLES-1:0] read;
    wire [SAMPLES-1:0] read_saturated, read_not_finite;
    localparam [63:0] DIGITS = "76543210"; // 0 in the lowest bits
    genvar sample;

    for (sample = 0; sample < SAMPLES; sample = sample + 1) begin : gen_samples
        wire signed [26:0] fixed;

        assign read[27*sample +: 27] = fixed;

        sptfra_samples #(
            .TAXELS       (BEATS),
            .SAMPLE       (SAMPLE),
            .NUMBER_SHIFT (NUMBER_SHIFT),
            .NUMBER_BOUND (NUMBER_BOUND),
            .COUNTS       (COUNTS),
            .CALIBRATED   (CALIBRATED),
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
            .TAXEL_NAME   ((ROM_NAME == "") ? "" : {ROM_NAME, "_sample", DIGITS[8*sample +: 8]})
        ) samples (
            .clock          (clock),
            .reset          (reset),
            .sample         (s_tdata[SAMPLE_BITS*sample +: SAMPLE_BITS]),
            .sample_taken   (takes[0]),
            .sample_ends    (ends[0]),
            .value_taken    (takes[VALUE_STAGES]),
            .value_ends     (ends[VALUE_STAGES]),
            .exponent_taxel (exponent_taxels[BEAT_WIDTH*sample +: BEAT_WIDTH]),
            .gain_taxel     (gain_taxels[BEAT_WIDTH*sample +: BEAT_WIDTH]),
            .bank_constants (constants),
            .bank_curve     (curve),
            .segment        (segment[LEVELS*sample +: LEVELS]),
            .bank_line      (line),
            .stress         (fixed),
            .saturated      (read_saturated[sample]),
            .not_finite     (read_not_finite[sample])
        );
    end

    // ---- A calibration in RAM
    wire [34*PLACES+8:0] map;

    if (CALIBRATED != 0) begin : gen_calibration
        wire [3:0] replaced;

        assign frame_calibration = {active_calibration[58:0], active_calibration[66:59], replaced};

        sptfra_banks #(
            .TAXELS           (TAXELS),
            .OFFSET_BITS      (OFFSET_BITS),
            .REPLACEABLE      ((MAPPED != 0) ? REPLACEABLE : 0),
            .REPLACED         (REPLACED[16*((MAPPED != 0) ? PLACES : 1)+15:0]),
            .CURVE_LEVELS     (CURVE_LEVELS),
            .CURVE_COUNT      (CURVE_COUNT),
            .CURVE_KNOTS      (CURVE_KNOTS),
            .CURVE_LAST       (CURVE_LAST),
            .CURVE_LAST_VALUE (CURVE_LAST_VALUE),
            .ROM_DIR          (ROM_DIR),
            .ROM_NAME         (ROM_NAME)
        ) banks (
            .clock          (clock),
            .reset          (reset),
            .command        (bank_command),
            .words          (bank_words),
            .tare_command   (tare_command),
            .tare_result    (tare_result),
            .most_spread    (active_calibration[26:0]),
            .active         (active),
            .active_count   (replaced),
            .opens          (opens),
            .exponent_bank  ((CURVE_LEVELS == 0) ? bank : bank_held),
            .exponent_taxel (exponent_taxels[TAXEL_WIDTH-1:0]),
            .bank           (bank_held),
            .gain_taxel     (gain_taxels[TAXEL_WIDTH-1:0]),
            .constants      (constants),
            .taxel_ahead    (taxel_ahead),
            .map            (map),
            .curve          (curve),
            .segment        (segment[LEVELS-1:0]),
            .line           (line),
            .read_valid     (out_valid),
            .read_last      (ends[STAGES]),
            .read_bad       (read_saturated[0] || read_not_finite[0] || !takes[STAGES]
                || (ends[STAGES] && out_bad_length)),
            .read           (read[26:0])
        );
    end else begin : gen_constant
        assign frame_calibration = 71'd0;
        assign bank_words = 1'b0;
        assign tare_result = 30'd0;
        assign {constants, curve, line, map} = {(OFFSET_BITS+27*(1<<LEVELS)+34*PLACES+176){1'b0}};
        wire _unused_calibration = &{1'b0, active_calibration, bank_command, tare_command, segment, CURVE_COUNT,
            CURVE_LAST_VALUE, exponent_taxels, gain_taxels, bank, out_valid};
    end

    // ---- Stresses to the lanes and to CeAn
    sptfra_frame_writer #(
        .COLUMNS           (COLUMNS),
        .ROWS              (ROWS),
        .SAMPLES           (SAMPLES),
        .CHANNELS          (CHANNELS),
        .DATA_BITS         (DATA_BITS),
        .STRESS_BOUND      (STRESS_BOUND),
        .SCALED            (SCALED),
        .REPLACEABLE       (REPLACEABLE),
        .MAPPED            (MAPPED),
        .REPLACED          (REPLACED),
        .CROSSTALK         (CROSSTALK),
        .CREEP             (CREEP),
        .SMOOTHING         (SMOOTHING),
        .ROM_DIR           (ROM_DIR),
        .ROM_NAME          (ROM_NAME)
    ) writer (
        .clock            (clock),
        .reset            (reset),
        .in_takes         (takes[STAGES]),
        .in_ends          (ends[STAGES]),
        .in_bad_length    (out_bad_length),
        .in_stresses      (read),
        .in_saturated     (read_saturated),
        .in_not_finite    (read_not_finite),
        .taxel_ahead      (taxel_ahead),
        .map              (map),
        .smoothing        (smoothing),
        .busy             (writer_busy),
        .replace_busy     (replace_busy),
        .write_valid      (write_valid),
        .write_ready      (write_ready),
        .write_bank       (write_bank),
        .write_row        (write_row),
        .write_data       (write_data),
        .stress_valid     (stress_valid),
        .stress           (stress),
        .frame_done       (frame_done),
        .frame_saturated  (frame_saturated),
        .frame_not_finite (frame_not_finite),
        .frame_bad_length (frame_bad_length),
        .frame_replaced   (frame_replaced),
        .scaled           (scaled),
        .exponent         (exponent),
        .smoothed         (smoothed),
        .frame_opens      (opens),
        .frame_ready      (frame_ready),
        .frame_start      (frame_start),
        .frame_release    (frame_release),
        .bank_free        (bank_free)
    );

endmodule

`default_nettype wire
