// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Bz with a calibration in RAM that has a curve: counts become the curve's pascals (sptfra_count_curve) by the bank
// that acts at a frame's first beat, then stress by that bank's gains and offsets (sptfra_bz_calibrated).
//
// What acted at a frame's first beat, thresholds and generation with it, goes with the frame. A tare begins behind the
// curve with the first frame that began after its command. The other bank is in use as long as a frame of it is here.

`default_nettype none

module sptfra_bz_curved #(
    // As of sptfra_bz_calibrated
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter WAYS = 4,
    parameter DATA_BITS = 27,
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    parameter DEAD = 0,
    parameter WEIGHT_SHIFT = 16,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    parameter EXPECTED_STAGES = 0,
    parameter SAMPLE = 0,
    parameter OFFSET_BITS = 29,
    parameter COUNT_SHIFT = 14,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter EXPECTED_CALIBRATION = 0,
    parameter REPLACEABLE = 0,
    parameter [3:0] REPLACED_COUNT = 4'd0,
    parameter [4:0] REPLACED_SHIFT = 5'd17,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)-1:0] REPLACED_TAXELS
        = {16*((REPLACEABLE != 0) ? REPLACEABLE : 1){1'b0}},
    // As of sptfra_count_curve and sptfra_curve_bank
    parameter CURVE_LEVELS = 4,
    parameter integer CURVE_NUMBER_SHIFT = 0,
    parameter integer CURVE_VALUE_LSB = 0,
    parameter [6:0] CURVE_COUNT = 7'd1,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b0}},
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    parameter signed [26:0] CURVE_LAST_VALUE = 27'sd0,
    parameter EXPECTED_CURVE = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter TAXELS = COLUMNS * ROWS,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter ELEMENTS = (WAYS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter TAXEL_COMMAND = TAXEL_WIDTH + OFFSET_BITS + 31,
    parameter TAXEL_RESULT = OFFSET_BITS + 28
) (
    input  wire clock,
    input  wire reset,
    // Samples in
    input  wire [SAMPLE_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // As of sptfra_bz
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [WAYS*DATA_BITS-1:0] write_data,
    input  wire cean_idle,
    input  wire direction_room,
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced,
    output wire frame_ready,
    input  wire frame_start,
    input  wire frame_release,
    // Calibration, as of sptfra_bz_calibrated; words behind the thresholds are there in any case
    input  wire [67:0] calibration_acting,
    output wire calibration_old_in_use,
    input  wire [TAXEL_COMMAND+55:0] bank_command,
    output wire [TAXEL_RESULT+33:0] bank_words,
    input  wire [TAXEL_WIDTH+4:0] tare_command,
    output wire [29:0] tare_result,
    // What a frame begins with: see sptfra_frame_context
    output wire frame_calibrates,
    output wire [70:0] frame_calibration
);

    localparam SEGMENTS = 1 << CURVE_LEVELS;
    // Word of a bank with which the curve begins
    localparam DEAD_WORDS = (REPLACEABLE != 0) ? 1 + REPLACEABLE + REPLACEABLE * TAXELS : 0;
    localparam [31:0] FIRST_WIDE = 2 * TAXELS + 2 + DEAD_WORDS;
    localparam [15:0] FIRST = FIRST_WIDE[15:0];
    localparam MAP_COMMAND = (REPLACEABLE != 0) ? 56 : 0;
    localparam MAP_RESULT = (REPLACEABLE != 0) ? 34 : 0;

    wire active = calibration_acting[67];
    wire tare_run = tare_command[TAXEL_WIDTH+4];
    wire [55:0] more_command = bank_command[TAXEL_COMMAND +: 56];
    wire of_curve = (more_command[47:32] >= FIRST);
    reg of_curve_1;
    wire [33:0] curve_result;

    always @(posedge clock) begin
        of_curve_1 <= of_curve;
    end

    // ---- The curve
    wire [31:0] pascals_tdata;
    wire pascals_tlast, pascals_tvalid, pascals_tready, pascals_begin;
    wire frame_begins;
    wire copying;
    wire [2*27*SEGMENTS-1:0] knots;
    wire [13:0] counts;
    wire [53:0] lasts;
    wire [53:0] reaches;
    wire line_enable, line_bank;
    wire [CURVE_LEVELS-1:0] line_segment;
    wire signed [26:0] line_first;
    wire signed [26:0] line_value;
    wire signed [17:0] line_slope;
    wire [5:0] line_shift;

    sptfra_curve_bank #(
        .LEVELS     (CURVE_LEVELS),
        .FIRST      (FIRST),
        .COUNT      (CURVE_COUNT),
        .KNOTS      (CURVE_KNOTS),
        .LAST       (CURVE_LAST),
        .LAST_VALUE (CURVE_LAST_VALUE),
        .ROM_DIR    (ROM_DIR),
        .ROM_NAME   (ROM_NAME)
    ) curve_bank (
        .clock        (clock),
        .command      ({more_command[55:51], more_command[50:49] & {2{of_curve}}, more_command[48:0]}),
        .result       (curve_result),
        .active       (active),
        .tare_run     (tare_run),
        .copying      (copying),
        .knots        (knots),
        .counts       (counts),
        .lasts        (lasts),
        .reaches      (reaches),
        .read_enable  (line_enable),
        .read_bank    (line_bank),
        .read_segment (line_segment),
        .read_first   (line_first),
        .read_value   (line_value),
        .read_slope   (line_slope),
        .read_shift   (line_shift)
    );

    sptfra_count_curve #(
        .SAMPLE          (SAMPLE),
        .LEVELS          (CURVE_LEVELS),
        .NUMBER_SHIFT    (CURVE_NUMBER_SHIFT),
        .VALUE_LSB       (CURVE_VALUE_LSB),
        .EXPECTED_STAGES (EXPECTED_CURVE)
    ) curve (
        .clock        (clock),
        .reset        (reset),
        .s_tdata      (s_tdata),
        .s_tlast      (s_tlast),
        .s_tvalid     (s_tvalid),
        .s_tready     (s_tready),
        .m_tdata      (pascals_tdata),
        .m_tlast      (pascals_tlast),
        .m_tvalid     (pascals_tvalid),
        .m_tready     (pascals_tready),
        .m_begins     (pascals_begin),
        .active       (active),
        .frame_begins (frame_begins),
        .knots        (knots),
        .counts       (counts),
        .lasts        (lasts),
        .reaches      (reaches),
        .line_enable  (line_enable),
        .line_bank    (line_bank),
        .line_segment (line_segment),
        .line_first   (line_first),
        .line_value   (line_value),
        .line_slope   (line_slope),
        .line_shift   (line_shift)
    );

    // ---- What a frame began with, until its last beat has left; four may be here
    reg [67:0] began [0:3]; // bank, generation, contact, noise
    reg [3:0] marks; // a tare was under way
    reg [1:0] newest;
    reg [1:0] oldest;
    reg [2:0] of_bank_0; // frames of it that are here
    reg [2:0] of_bank_1;
    reg tares;
    wire [67:0] began_with = began[oldest];
    wire offered = pascals_tvalid && pascals_begin;
    wire leaves = pascals_tvalid && pascals_tready && pascals_tlast;
    wire leaves_bank = began_with[67];
    wire tare_here = tare_run && (tares || (offered && marks[oldest]));
    wire in_use;
    wire [67:0] acting = offered ? began_with : calibration_acting;
    wire [29:0] inner_result;

    assign calibration_old_in_use = in_use || ((active ? of_bank_0 : of_bank_1) != 3'd0);
    assign tare_result = {inner_result[29] && !copying, inner_result[28:0]};

    always @(posedge clock) begin
        if (frame_begins) begin
            began[newest] <= calibration_acting;
            marks[newest] <= tare_run;
            newest <= newest + 2'd1;
        end
        if (leaves) begin
            oldest <= oldest + 2'd1;
        end
        of_bank_0 <= of_bank_0 + {2'd0, frame_begins && !active} - {2'd0, leaves && !leaves_bank};
        of_bank_1 <= of_bank_1 + {2'd0, frame_begins && active} - {2'd0, leaves && leaves_bank};
        tares <= tare_here;
        if (!tare_run) begin
            marks <= 4'd0;
        end
        if (reset) begin
            newest <= 2'd0;
            oldest <= 2'd0;
            of_bank_0 <= 3'd0;
            of_bank_1 <= 3'd0;
            marks <= 4'd0;
            tares <= 1'b0;
        end
    end

    // ---- Gains, offsets and what is behind them
    wire [TAXEL_COMMAND+MAP_COMMAND-1:0] inner_command;
    wire [TAXEL_RESULT+MAP_RESULT-1:0] inner_words;

    assign inner_command[TAXEL_COMMAND-1:0] = bank_command[TAXEL_COMMAND-1:0];
    assign bank_words[TAXEL_RESULT-1:0] = inner_words[TAXEL_RESULT-1:0];

    generate
        if (REPLACEABLE != 0) begin : gen_map
            wire [33:0] map_result = inner_words[TAXEL_RESULT +: 34];

            assign inner_command[TAXEL_COMMAND +: 56]
                = {more_command[55:51], more_command[50:49] & {2{!of_curve}}, more_command[48:0]};
            assign bank_words[TAXEL_RESULT +: 34] = {
                curve_result[33] || map_result[33],
                of_curve ? curve_result[32] : map_result[32],
                of_curve_1 ? curve_result[31:0] : map_result[31:0]
            };
        end else begin : gen_no_map
            assign bank_words[TAXEL_RESULT +: 34] = curve_result;
            wire _unused = &{1'b0, of_curve_1};
        end
    endgenerate

    sptfra_bz_calibrated #(
        .COLUMNS              (COLUMNS),
        .ROWS                 (ROWS),
        .WAYS                 (WAYS),
        .DATA_BITS            (DATA_BITS),
        .NUMBER_SHIFT         (NUMBER_SHIFT),
        .NUMBER_BOUND         (NUMBER_BOUND),
        .DEAD                 (DEAD),
        .WEIGHT_SHIFT         (WEIGHT_SHIFT),
        .STRESS_BOUND         (STRESS_BOUND),
        .ROM_DIR              (ROM_DIR),
        .ROM_NAME             (ROM_NAME),
        .EXPECTED_STAGES      (EXPECTED_STAGES),
        .OFFSET_BITS          (OFFSET_BITS),
        .COUNT_SHIFT          (COUNT_SHIFT),
        .FULL_SCALE           (FULL_SCALE),
        .EXPECTED_CALIBRATION (EXPECTED_CALIBRATION),
        .REPLACEABLE          (REPLACEABLE),
        .REPLACED_COUNT       (REPLACED_COUNT),
        .REPLACED_SHIFT       (REPLACED_SHIFT),
        .REPLACED_TAXELS      (REPLACED_TAXELS)
    ) calibrated (
        .clock                  (clock),
        .reset                  (reset),
        .s_tdata                (pascals_tdata),
        .s_tlast                (pascals_tlast),
        .s_tvalid               (pascals_tvalid),
        .s_tready               (pascals_tready),
        .write_valid            (write_valid),
        .write_ready            (write_ready),
        .write_bank             (write_bank),
        .write_row              (write_row),
        .write_data             (write_data),
        .cean_idle              (cean_idle),
        .direction_room         (direction_room),
        .stress_valid           (stress_valid),
        .stress                 (stress),
        .frame_done             (frame_done),
        .frame_saturated        (frame_saturated),
        .frame_not_finite       (frame_not_finite),
        .frame_bad_length       (frame_bad_length),
        .frame_replaced         (frame_replaced),
        .frame_ready            (frame_ready),
        .frame_start            (frame_start),
        .frame_release          (frame_release),
        .calibration_acting     (acting),
        .calibration_old_in_use (in_use),
        .bank_command           (inner_command),
        .bank_words             (inner_words),
        .tare_command           ({tare_here, tare_command[TAXEL_WIDTH+3:0]}),
        .tare_result            (inner_result),
        .frame_calibrates       (frame_calibrates),
        .frame_calibration      (frame_calibration)
    );

endmodule

`default_nettype wire
