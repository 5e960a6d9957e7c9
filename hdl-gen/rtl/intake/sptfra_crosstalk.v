// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Correction of a row-column array's crosstalk: a share of the sums of a taxel's row and column, and of the frame.
//
// stress = reading - a P - b Q + d S: sums P of the row, Q of the column, S of the frame. A frame is kept while they
// add up; then one multiplier makes a term of each sum, and the frame is read again. Last reading in to last one out:
// TAXELS + COLUMNS + ROWS + 8 cycles. `busy` keeps the next frame back.

`default_nettype none

module sptfra_crosstalk #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Factors a, b, d of sums over the powers of two that hold their taxels
    parameter [17:0] ROW_FACTOR = 18'd0,
    parameter [17:0] COLUMN_FACTOR = 18'd0,
    parameter [17:0] TOTAL_FACTOR = 18'd0,
    // Fraction bits of the factors
    parameter FRACTION = 17,
    // Full scale: what a larger stress becomes
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000
) (
    input  wire clock,
    input  wire reset,
    // Readings; with each what is kept beside it
    input  wire in_takes, // it is a taxel of the frame
    input  wire in_ends, // the frame ends, with its last taxel or behind it
    input  wire in_bad_length,
    input  wire [26:0] in_stress,
    input  wire [2:0] in_flags,
    // The frame again
    output reg  busy, // from the last reading in to the last one out
    output wire out_takes,
    output wire out_ends,
    output reg  out_bad_length,
    output reg  [26:0] out_stress,
    output reg  [2:0] out_flags
);

    localparam TAXELS = COLUMNS * ROWS;
    localparam TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1;
    localparam X_WIDTH = $clog2(COLUMNS);
    localparam Y_WIDTH = $clog2(ROWS);
    localparam SUM_BITS = 27 + ((X_WIDTH > Y_WIDTH) ? X_WIDTH : Y_WIDTH);
    localparam signed [SUM_BITS+1:0] MOST = {{(SUM_BITS-25){1'b0}}, STRESS_BOUND};
    localparam TOTAL_BITS = 27 + X_WIDTH + Y_WIDTH;
    localparam STEPS = COLUMNS + ROWS + 5; // from the first term to reading again
    localparam STEP_WIDTH = $clog2(STEPS + 1);
    localparam [31:0] LAST_X = COLUMNS - 1;
    localparam [31:0] LAST_STEP_WIDE = STEPS - 1;
    localparam [31:0] FIRST_ROW_WIDE = COLUMNS + 1;
    localparam [31:0] END_WIDE = COLUMNS + ROWS;

    // ---- Sums as the frame comes, which become terms; and the place of the reading, coming or read again
    (* ram_style = "distributed" *) reg signed [SUM_BITS-1:0] column_sums [0:COLUMNS-1];
    (* ram_style = "distributed" *) reg signed [SUM_BITS-1:0] row_sums [0:ROWS-1];
    reg signed [TOTAL_BITS-1:0] total;
    reg [TAXEL_WIDTH-1:0] place;
    reg [TAXEL_WIDTH-1:0] end_place; // of the last reading
    reg [X_WIDTH-1:0] column;
    reg [Y_WIDTH-1:0] row;
    reg [STEP_WIDTH-1:0] step;
    reg works; // on the terms
    reg replays;
    wire replays_last = replays && (place == end_place);
    wire last_column = (column == LAST_X[X_WIDTH-1:0]);
    wire signed [SUM_BITS-1:0] reading = {{(SUM_BITS-27){in_stress[26]}}, in_stress};

    always @(posedge clock) begin
        if (in_takes || replays) begin
            place <= place + 1'b1;
            column <= last_column ? {X_WIDTH{1'b0}} : column + 1'b1;
            if (last_column) begin
                row <= row + 1'b1;
            end
        end
        if (in_takes) begin
            end_place <= place;
            total <= ((place == {TAXEL_WIDTH{1'b0}}) ? {TOTAL_BITS{1'b0}} : total)
                + {{(TOTAL_BITS-27){in_stress[26]}}, in_stress};
        end
        step <= step + 1'b1;
        if (works && (step == LAST_STEP_WIDE[STEP_WIDTH-1:0])) begin
            works <= 1'b0;
            replays <= 1'b1;
        end
        if (in_ends) begin
            out_bad_length <= in_bad_length;
            busy <= 1'b1;
            works <= 1'b1;
            step <= {STEP_WIDTH{1'b0}};
        end
        if (replays_last) begin
            replays <= 1'b0;
        end
        if (reset || in_ends || replays_last) begin
            place <= {TAXEL_WIDTH{1'b0}};
            column <= {X_WIDTH{1'b0}};
            row <= {Y_WIDTH{1'b0}};
        end
        if (out_ends) begin
            busy <= 1'b0;
        end
        if (reset) begin
            busy <= 1'b0;
            works <= 1'b0;
            replays <= 1'b0;
        end
    end

    // ---- Terms: of the frame first, of the columns, of the rows. Names end in the cycles since a step
    wire [31:0] step_wide = {{(32-STEP_WIDTH){1'b0}}, step};
    wire [31:0] of_column = step_wide - 32'd1;
    wire [31:0] of_row = step_wide - FIRST_ROW_WIDE;
    wire is_total = (step_wide == 32'd0);
    wire is_row = (step_wide >= FIRST_ROW_WIDE);
    wire is_term = works && (step_wide <= END_WIDE);
    reg [4:1] totals;
    reg [4:1] columns;
    reg [4:1] rows;
    reg [4*X_WIDTH-1:0] columns_to;
    reg [4*Y_WIDTH-1:0] rows_to;
    reg signed [26:0] sum_1;
    reg [17:0] factor_1;
    wire signed [44:0] product_2;
    reg signed [44:0] product_3; // twice what it is, to be rounded
    reg signed [SUM_BITS-1:0] term_4;
    reg signed [SUM_BITS-1:0] total_term;
    wire signed [44:0] half_3 = product_3 + 45'sd1;
    wire signed [SUM_BITS-1:0] of_sum = is_row ? row_sums[of_row[Y_WIDTH-1:0]] : column_sums[of_column[X_WIDTH-1:0]];

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient (factor_1),
        .data        (sum_1),
        .product     (product_2)
    );

    always @(posedge clock) begin
        totals <= {totals[3:1], is_term && is_total};
        columns <= {columns[3:1], is_term && !is_total && !is_row};
        rows <= {rows[3:1], is_term && is_row};
        columns_to <= {columns_to[3*X_WIDTH-1:0], of_column[X_WIDTH-1:0]};
        rows_to <= {rows_to[3*Y_WIDTH-1:0], of_row[Y_WIDTH-1:0]};
        sum_1 <= is_total ? total[TOTAL_BITS-1 -: 27] : of_sum[SUM_BITS-1 -: 27];
        factor_1 <= is_total ? TOTAL_FACTOR : is_row ? ROW_FACTOR : COLUMN_FACTOR;
        product_3 <= product_2 >>> (FRACTION - 1);
        term_4 <= half_3[SUM_BITS:1];
        if (totals[4]) begin
            total_term <= term_4;
        end
        if (in_takes) begin
            column_sums[column] <= (row == {Y_WIDTH{1'b0}}) ? reading : column_sums[column] + reading;
        end else if (columns[4]) begin
            column_sums[columns_to[4*X_WIDTH-1 -: X_WIDTH]] <= term_4 - total_term;
        end
        if (in_takes) begin
            row_sums[row] <= (column == {X_WIDTH{1'b0}}) ? reading : row_sums[row] + reading;
        end else if (rows[4]) begin
            row_sums[rows_to[4*Y_WIDTH-1 -: Y_WIDTH]] <= term_4;
        end
        if (reset) begin
            {totals, columns, rows} <= 12'd0;
        end
    end

    // ---- The frame again, less its terms
    wire [29:0] kept_1;
    reg signed [SUM_BITS:0] terms_1;
    reg signed [SUM_BITS+1:0] stress_2;
    reg [2:0] flags_2;
    reg [3:1] valid;
    reg [3:1] lasts;
    wire above = (stress_2 > MOST);
    wire below = (stress_2 < -MOST);

    assign out_takes = valid[3];
    assign out_ends = lasts[3];

    sptfra_ram #(
        .WIDTH         (30),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) frame (
        .clock         (clock),
        .write_enable  (in_takes),
        .write_address (place),
        .write_data    ({in_flags, in_stress}),
        .read_enable   (1'b1),
        .read_address  (place),
        .read_data     (kept_1)
    );

    always @(posedge clock) begin
        valid <= {valid[2:1], replays};
        lasts <= {lasts[2:1], replays_last};
        terms_1 <= {column_sums[column][SUM_BITS-1], column_sums[column]}
            + {row_sums[row][SUM_BITS-1], row_sums[row]};
        stress_2 <= {{(SUM_BITS-25){kept_1[26]}}, kept_1[26:0]} - {terms_1[SUM_BITS], terms_1};
        flags_2 <= kept_1[29:27];
        out_stress <= above ? STRESS_BOUND : below ? -STRESS_BOUND : stress_2[26:0];
        out_flags <= flags_2;
        if (reset) begin
            valid <= 3'd0;
            lasts <= 3'd0;
        end
    end

    wire _unused = &{1'b0, total, of_sum, half_3, of_column, of_row, step_wide};

endmodule

`default_nettype wire
