// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Both banks of a calibration, and its tare: gains and offsets, then a map of dead taxels and a curve where the design
// has them. One bank is active, the other one is written.
//
// Reads take an enabled cycle: exponents, gains and offsets, weights of `taxel_ahead`, the line of `segment`. All else
// is that of the chosen bank in the same cycle.

`default_nettype none

module sptfra_banks #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Bits of an offset, in steps of the stress
    parameter OFFSET_BITS = 29,
    // Places of the map, 0 without one, and its content at power-up: see sptfra_dead_bank
    parameter REPLACEABLE = 0,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)+15:0] REPLACED = 0,
    // Room for 2^CURVE_LEVELS segments, 0 without a curve, and its content at power-up: see sptfra_curve_bank
    parameter CURVE_LEVELS = 0,
    parameter [6:0] CURVE_COUNT = 7'd1,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b0}},
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    parameter signed [26:0] CURVE_LAST_VALUE = 27'sd0,
    // Prefix of the names of the files with the content at power-up, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter PLACES = (REPLACEABLE != 0) ? REPLACEABLE : 1,
    parameter LEVELS = (CURVE_LEVELS != 0) ? CURVE_LEVELS : 1,
    parameter HAS_MORE = ((REPLACEABLE != 0) || (CURVE_LEVELS != 0)) ? 1 : 0,
    parameter COMMAND_BITS = TAXEL_WIDTH + OFFSET_BITS + 31 + 56 * HAS_MORE,
    parameter WORDS_BITS = OFFSET_BITS + 28 + 34 * HAS_MORE
) (
    input  wire clock,
    input  wire reset,
    // {of map and curve as of sptfra_dead_bank; write gain, write offset, {bank, taxel}, gain, offset}, and the answer
    input  wire [COMMAND_BITS-1:0] command,
    output wire [WORDS_BITS-1:0] words,
    // {run, log2 of frames, taxel}; {finished, restless, bad frame, mean}
    input  wire [TAXEL_WIDTH+4:0] tare_command,
    output wire [29:0] tare_result,
    input  wire [26:0] most_spread,
    input  wire active,
    output wire [3:0] active_count, // dead taxels of the active bank
    // Reads
    input  wire opens, // a frame begins
    input  wire exponent_bank,
    input  wire [TAXEL_WIDTH-1:0] exponent_taxel,
    input  wire bank, // of all else
    input  wire [TAXEL_WIDTH-1:0] gain_taxel,
    output wire [OFFSET_BITS+27:0] constants, // exponent, gain, offset
    input  wire [TAXEL_WIDTH-1:0] taxel_ahead,
    output wire [34*PLACES+8:0] map, // weights, count, shift of the weights, numbers: see sptfra_replace
    output wire [27*(1<<LEVELS)+60:0] curve, // knots, segments, last, reach: see sptfra_curve_bank
    input  wire [LEVELS-1:0] segment,
    output wire [77:0] line, // as sptfra_curve takes it
    // Stresses of the frames, for a tare
    input  wire read_valid,
    input  wire read_last,
    input  wire read_bad, // clipped, no number, or of a frame of another length
    input  wire signed [26:0] read
);

    localparam SEGMENTS = 1 << LEVELS;
    // Words of a bank with which the map and the curve begin
    localparam [31:0] FIRST_OF_MAP = 2 * TAXELS + 2;
    localparam [31:0] FIRST_OF_CURVE = FIRST_OF_MAP + ((REPLACEABLE != 0) ? 1 + REPLACEABLE + REPLACEABLE * TAXELS : 0);

    wire [9:0] exponent;
    wire [17:0] gain;
    wire [OFFSET_BITS-1:0] offset;
    wire [18*PLACES-1:0] weights;
    wire [3:0] count;
    wire [4:0] weight_shift;
    wire [16*PLACES-1:0] numbers;
    wire [27*(1<<LEVELS)-1:0] knots;
    wire [6:0] segments;
    wire signed [26:0] last;
    wire [26:0] reach; // magnitude from which on a number is at an end of the curve
    reg marked; // the frame that is read began with the tare under way
    wire tare_run = tare_command[TAXEL_WIDTH+4];
    wire copying; // of the curve
    wire finished;

    assign constants = {exponent, gain, offset};
    assign map = {weights, count, weight_shift, numbers};
    assign curve = {knots, segments, last, reach};

    // ---- Gains and offsets
    wire write_gain, write_offset;
    wire [TAXEL_WIDTH:0] address;
    wire [27:0] gain_in;
    wire [OFFSET_BITS-1:0] offset_in;

    assign {write_gain, write_offset, address, gain_in, offset_in} = command[TAXEL_WIDTH+OFFSET_BITS+30:0];

    sptfra_bank #(
        .WIDTH         (10),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_exponents.mem"})
    ) exponents (
        .clock        (clock),
        .write_enable (write_gain),
        .address      (address),
        .write_data   (gain_in[27:18]),
        .data         (words[OFFSET_BITS+18 +: 10]),
        .read_address ({exponent_bank, exponent_taxel}),
        .read_data    (exponent)
    );

    sptfra_bank #(
        .WIDTH         (18),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_gains.mem"})
    ) gains (
        .clock        (clock),
        .write_enable (write_gain),
        .address      (address),
        .write_data   (gain_in[17:0]),
        .data         (words[OFFSET_BITS +: 18]),
        .read_address ({bank, gain_taxel}),
        .read_data    (gain)
    );

    sptfra_bank #(
        .WIDTH         (OFFSET_BITS),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_offsets.mem"})
    ) offsets (
        .clock        (clock),
        .write_enable (write_offset),
        .address      (address),
        .write_data   (offset_in),
        .data         (words[OFFSET_BITS-1:0]),
        .read_address ({bank, gain_taxel}),
        .read_data    (offset)
    );

    // ---- Words behind the thresholds: of the map, then of the curve
    wire [33:0] map_result;
    wire [33:0] curve_result;
    wire of_curve;

    if (HAS_MORE != 0) begin : gen_more
        reg of_curve_1;

        assign words[OFFSET_BITS+28 +: 34] = {
            curve_result[33] || map_result[33],
            of_curve ? curve_result[32] : map_result[32],
            of_curve_1 ? curve_result[31:0] : map_result[31:0]
        };
        assign of_curve = (CURVE_LEVELS != 0)
            && (command[TAXEL_WIDTH+OFFSET_BITS+63 +: 16] >= FIRST_OF_CURVE[15:0]);

        always @(posedge clock) begin
            of_curve_1 <= of_curve;
        end
    end else begin : gen_thresholds_last
        assign of_curve = 1'b0;
        wire _unused_results = &{1'b0, map_result, curve_result, of_curve};
    end
    if (REPLACEABLE != 0) begin : gen_map
        wire [55:0] more = command[COMMAND_BITS-1 -: 56];

        sptfra_dead_bank #(
            .TAXELS       (TAXELS),
            .REPLACEABLE  (REPLACEABLE),
            .FIRST        (FIRST_OF_MAP[15:0]),
            .COUNT        (REPLACED[3:0]),
            .WEIGHT_SHIFT (REPLACED[8:4]),
            .NUMBERS      (REPLACED[16 +: 16*REPLACEABLE]),
            .ROM_DIR      (ROM_DIR),
            .ROM_NAME     (ROM_NAME)
        ) dead_bank (
            .clock        (clock),
            .command      ({more[55:51], more[50:49] & {2{!of_curve}}, more[48:0]}),
            .result       (map_result),
            .active       (active),
            .active_count (active_count),
            .read_bank    (bank),
            .read_taxel   (taxel_ahead),
            .read_weights (weights),
            .read_count   (count),
            .read_shift   (weight_shift),
            .read_numbers (numbers)
        );
    end else begin : gen_no_map
        assign map_result = 34'd0;
        assign active_count = 4'd0;
        assign weights = {18*PLACES{1'b0}};
        assign count = 4'd0;
        assign weight_shift = 5'd0;
        assign numbers = {16*PLACES{1'b0}};
        wire _unused_map = &{1'b0, FIRST_OF_MAP, REPLACED};
    end
    if (CURVE_LEVELS != 0) begin : gen_curve
        wire [55:0] more = command[COMMAND_BITS-1 -: 56];
        wire [2*27*SEGMENTS-1:0] both_knots;
        wire [13:0] both_counts;
        wire [53:0] lasts, reaches;
        wire [5:0] shift;

        assign knots = bank ? both_knots[27*SEGMENTS +: 27*SEGMENTS] : both_knots[0 +: 27*SEGMENTS];
        assign segments = bank ? both_counts[13:7] : both_counts[6:0];
        assign last = bank ? $signed(lasts[53:27]) : $signed(lasts[26:0]);
        assign reach = bank ? reaches[53:27] : reaches[26:0];
        assign line[5:0] = shift - 6'd1;

        sptfra_curve_bank #(
            .LEVELS     (CURVE_LEVELS),
            .FIRST      (FIRST_OF_CURVE[15:0]),
            .COUNT      (CURVE_COUNT),
            .KNOTS      (CURVE_KNOTS),
            .LAST       (CURVE_LAST),
            .LAST_VALUE (CURVE_LAST_VALUE),
            .ROM_DIR    (ROM_DIR),
            .ROM_NAME   (ROM_NAME)
        ) curve_bank (
            .clock        (clock),
            .command      ({more[55:51], more[50:49] & {2{of_curve}}, more[48:0]}),
            .result       (curve_result),
            .active       (active),
            .tare_run     (tare_run),
            .copying      (copying),
            .knots        (both_knots),
            .counts       (both_counts),
            .lasts        (lasts),
            .reaches      (reaches),
            .read_bank    (bank),
            .read_segment (segment),
            .read_line    ({line[77:6], shift})
        );
    end else begin : gen_no_curve
        assign curve_result = 34'd0;
        assign copying = 1'b0;
        assign knots = {27*SEGMENTS{1'b0}};
        assign segments = 7'd0;
        assign last = 27'sd0;
        assign reach = 27'd0;
        assign line = 78'd0;
        wire _unused_curve = &{1'b0, segment, tare_run, CURVE_COUNT, CURVE_KNOTS, CURVE_LAST, CURVE_LAST_VALUE};
    end
    if (HAS_MORE == 0) begin : gen_only
        wire _unused_more = &{1'b0, active, FIRST_OF_CURVE};
    end

    // ---- Tare
    assign tare_result[29] = finished && !copying;

    always @(posedge clock) begin
        if (opens) begin
            marked <= 1'b1;
        end
        // What is left of a frame when its tare ends is none of the next one's
        if (reset || !tare_run) begin
            marked <= 1'b0;
        end
    end

    sptfra_tare #(
        .TAXELS (TAXELS)
    ) tare (
        .clock       (clock),
        .reset       (reset),
        .run         (tare_run),
        .log2_frames (tare_command[TAXEL_WIDTH +: 4]),
        .most_spread (most_spread),
        .valid       (read_valid),
        .marked      (marked),
        .last        (read_last),
        .bad         (read_bad),
        .taxel_ahead (taxel_ahead),
        .reading     (read),
        .finished    (finished),
        .restless    (tare_result[28]),
        .bad_frame   (tare_result[27]),
        .mean_taxel  (tare_command[TAXEL_WIDTH-1:0]),
        .mean        (tare_result[26:0])
    );

    wire _unused = &{1'b0, FIRST_OF_CURVE[31:16], FIRST_OF_MAP[31:16]};

endmodule

`default_nettype wire
