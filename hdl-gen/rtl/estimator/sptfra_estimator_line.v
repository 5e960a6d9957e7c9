// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Line search estimator: friction on the line that the direction of the push allows (the paper's Algorithm 1).
//
// Two stages, each with its own frame: the line in the (mu_x, mu_y) plane, then the search along it. The search
// begins when the frame's u_q are in its cells. The answer is the free component t and the line: the other component
// is other + slope * free.
//
// Latency of the stages: EXPECTED_LINE_LATENCY and EXPECTED_SEARCH_LATENCY. Interval: that of the longer one.

`default_nettype none

module sptfra_estimator_line #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Taxels that arrive at a time: 4, the images of an orbit, or 1
    parameter integer CHANNELS = 4,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Cells of the search, a multiplier each; as many for each channel
    parameter integer CELLS = 16,
    // Taxels of a cell, a power of two
    parameter integer CELL_ELEMENTS = 8,
    // Points of a round of the search: 1, or 3 for two bisections at a time
    parameter integer POINTS = 1,
    // Left shift (negative: right) that turns sum |b| into the level above the least B
    parameter integer LEVEL_SHIFT = -1,
    // 1: with a standard error, and its constants: see sptfra_standard_error
    parameter integer WITH_ERROR = 0,
    parameter [17:0] ERROR_MODEL = 18'd0,
    parameter [16:0] ERROR_NOISE = 17'd0,
    parameter [16:0] ERROR_BORDER = 17'd0,
    parameter [22:0] ERROR_LARGEST = 23'd0,
    parameter integer ERROR_AVERAGED = 0,
    // From the direction to the line, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LINE_LATENCY = 0,
    // From the start of a search to its end, checked in simulation; 0: unchecked
    parameter integer EXPECTED_SEARCH_LATENCY = 0,
    // Derived: orbits, or taxels, and the bits of their number
    parameter integer ELEMENTS = (CHANNELS == 4) ? ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2) : COLUMNS * ROWS,
    parameter integer ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // u_q of a frame, channel 0 in the lowest bits
    input  wire [2:0] u_valid, // q, one-hot
    input  wire [ROW_WIDTH-1:0] u_row,
    input  wire [CHANNELS*DATA_BITS-1:0] u_values,
    input  wire u_complete, // one cycle, with the last ones
    // From Co, held until taken
    input  wire sums_complete,
    output wire sums_take,
    input  wire [18*40-1:0] sums_in,
    // From CeAn, held until taken
    input  wire direction_valid,
    output wire direction_take,
    input  wire signed [26:0] direction_x,
    input  wire signed [26:0] direction_y,
    input  wire no_direction,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest,
    input  wire [39:0] border,
    input  wire [24:0] variance,
    input  wire [4:0] exponent,
    input  wire [5:0] flags_in, // no tension, too much replaced, no contact, saturated, NaN or infinity, bad length
    // One cycle: the place of a frame's u_q is free
    output wire u_released,
    // The answer, held until taken, the sums for a cycle more
    output wire answer_valid,
    input  wire answer_take, // only with answer_valid
    output reg  x_is_free, // the free component is mu_x
    output wire signed [17:0] free, // 16 fraction bits
    output wire signed [17:0] other, // of the other component: offset and slope, 15 fraction bits
    output wire signed [17:0] slope,
    output wire signed [17:0] error_log, // of base 2, of the error of (F_x, F_y) over |F_z|, 12 fraction bits
    output reg  unknown,
    output wire at_bound,
    output wire saturated,
    output reg  [18*40-1:0] sums,
    output reg  [5:0] flags
);

    if ((CHANNELS != 1) && (CHANNELS != 4)) begin : gen_check
        sptfra_error_channels_must_be_1_or_4 invalid ();
    end

    // ---- u_q: a register on the way to all cells
    reg [2:0] fill_valid;
    reg [ROW_WIDTH-1:0] fill_row;
    reg [CHANNELS*DATA_BITS-1:0] fill_values;
    reg fill_complete;

    always @(posedge clock) begin
        fill_valid <= u_valid;
        fill_row <= u_row;
        fill_values <= u_values;
        fill_complete <= u_complete;
        if (reset) begin
            fill_valid <= 3'd0;
            fill_complete <= 1'b0;
        end
    end

    // ---- Line
    wire line_valid;
    wire line_take;
    wire [18*40-1:0] line_sums;
    wire line_x_is_free;
    wire line_unknown;
    wire signed [17:0] line_c0;
    wire signed [17:0] line_c1;
    reg [39:0] line_stress_sum;
    reg [26:0] line_largest;
    reg [39:0] line_border;
    reg [24:0] line_variance;
    reg [4:0] line_exponent;
    reg [5:0] line_flags;

    always @(posedge clock) begin
        if (direction_take) begin
            line_stress_sum <= stress_sum;
            line_largest <= largest;
            line_border <= border;
            line_variance <= variance;
            line_exponent <= exponent;
            line_flags <= flags_in;
        end
    end

    sptfra_line #(
        .EXPECTED_LATENCY (EXPECTED_LINE_LATENCY)
    ) line (
        .clock           (clock),
        .reset           (reset),
        .sums_complete   (sums_complete),
        .sums_take       (sums_take),
        .sums_in         (sums_in),
        .direction_valid (direction_valid),
        .direction_take  (direction_take),
        .direction_x     (direction_x),
        .direction_y     (direction_y),
        .no_direction    (no_direction),
        .line_valid      (line_valid),
        .line_take       (line_take),
        .sums            (line_sums),
        .x_is_free       (line_x_is_free),
        .unknown         (line_unknown),
        .c0              (line_c0),
        .c1              (line_c1)
    );

    // ---- Search: takes the line when u_q is complete
    reg [1:0] u_waiting; // frames whose u_q wait in the cells
    reg fill_bank;
    reg search_bank;
    reg searching;
    reg answer_waits; // to be taken
    reg signed [17:0] c0;
    reg signed [17:0] c1;
    reg [39:0] search_stress_sum;
    wire search_done;
    wire search_start = line_valid && (u_waiting != 2'd0) && !searching;

    assign line_take = search_start;
    assign u_released = answer_take;
    assign answer_valid = search_done || answer_waits;
    assign other = c0;
    assign slope = c1;

    always @(posedge clock) begin
        u_waiting <= u_waiting + {1'b0, fill_complete} - {1'b0, search_start};
        if (fill_complete) begin
            fill_bank <= !fill_bank;
        end
        if (search_start) begin
            searching <= 1'b1;
            x_is_free <= line_x_is_free;
            unknown <= line_unknown;
            c0 <= line_c0;
            c1 <= line_c1;
            sums <= line_sums;
            search_stress_sum <= line_stress_sum;
            flags <= line_flags;
        end
        if (search_done) begin
            answer_waits <= 1'b1;
        end
        if (answer_take) begin
            searching <= 1'b0;
            answer_waits <= 1'b0;
            search_bank <= !search_bank;
        end
        if (reset) begin
            u_waiting <= 2'd0;
            fill_bank <= 1'b0;
            search_bank <= 1'b0;
            searching <= 1'b0;
            answer_waits <= 1'b0;
        end
    end

    sptfra_search #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .CHANNELS         (CHANNELS),
        .DATA_BITS        (DATA_BITS),
        .ROW_WIDTH        (ROW_WIDTH),
        .CELLS            (CELLS),
        .CELL_ELEMENTS    (CELL_ELEMENTS),
        .POINTS           (POINTS),
        .LEVEL_SHIFT      (LEVEL_SHIFT),
        .EXPECTED_LATENCY (EXPECTED_SEARCH_LATENCY)
    ) search (
        .clock       (clock),
        .reset       (reset),
        .u_valid     (fill_valid),
        .u_row       (fill_row),
        .u_values    (fill_values),
        .fill_bank   (fill_bank),
        .search_bank (search_bank),
        .start       (search_start),
        .x_is_free   (x_is_free),
        .next_c0     (line_c0),
        .c0          (c0),
        .c1          (c1),
        .stress_sum  (search_stress_sum),
        .done        (search_done),
        .t           (free),
        .at_bound    (at_bound),
        .saturated   (saturated)
    );

    // ---- Standard error: during the search
    if (WITH_ERROR != 0) begin : gen_error
        wire signed [17:0] found_error;

        sptfra_standard_error #(
            .MODEL    (ERROR_MODEL),
            .NOISE    (ERROR_NOISE),
            .BORDER   (ERROR_BORDER),
            .LARGEST  (ERROR_LARGEST),
            .AVERAGED (ERROR_AVERAGED)
        ) standard_error (
            .clock          (clock),
            .reset          (reset),
            .start          (search_start),
            .stress_sum     (line_stress_sum),
            .largest        (line_largest),
            .frame_exponent (line_exponent),
            .border         (line_border),
            .variance       (line_variance),
            .error_log      (found_error)
        );

        assign error_log = unknown ? 18'sd0 : found_error; // without a direction as much as presses
    end else begin : gen_no_error
        assign error_log = 18'sd0;

        wire _unused = &{1'b0, line_largest, line_border, line_variance, line_exponent, ERROR_MODEL, ERROR_NOISE,
            ERROR_BORDER, ERROR_LARGEST, ERROR_AVERAGED != 0};
    end

endmodule

`default_nettype wire
