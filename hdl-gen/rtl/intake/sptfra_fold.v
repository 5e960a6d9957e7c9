// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Folds the stresses of a frame, taxel after taxel, into the four parity classes of the lanes' operand memories.
//
// A quad is a taxel and its mirror images in x, in y and in both; class c of it is their sum with the signs of
// parity: even and even, odd in x, odd in y, odd in both. First each row folds onto its left half, then the lower rows
// onto the upper ones: a quad is complete with the last of its four taxels. Taxel to quad: 3 cycles.
// A class has the bits of a stress and four times its step; or, where there is room for the sum of four, its step.

`default_nettype none

module sptfra_fold #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of a stress, and of a class: as many, or two more, or beyond
    parameter STRESS_BITS = 27,
    parameter DATA_BITS = 27,
    // Derived
    parameter QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // From Bz
    input  wire in_valid,
    input  wire in_store, // a taxel of the frame, rather than what follows a frame that is too long
    input  wire in_last,
    input  wire signed [STRESS_BITS-1:0] in_stress,
    // Operand memories
    output wire write_valid,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_quad,
    output wire [4*DATA_BITS-1:0] write_data, // class 0 in the lowest bits
    output wire frame_written // the frame is complete
);

    localparam SUM_BITS = STRESS_BITS + 2;
    localparam DROPPED = (DATA_BITS < SUM_BITS) ? 2 : 0; // bits of a sum
    localparam LAST_TO_WRITTEN = 3; // cycles, which simulations check of a frame that flows
    localparam QUAD_COLUMNS = (COLUMNS + 1) / 2;
    localparam QUAD_ROWS = (ROWS + 1) / 2;
    localparam X_WIDTH = $clog2(COLUMNS);
    localparam Y_WIDTH = $clog2(ROWS);
    localparam QUAD_X_WIDTH = (QUAD_COLUMNS > 2) ? $clog2(QUAD_COLUMNS) : 1;
    localparam UPPER_DEPTH = (QUADS > 8) ? QUADS : 8;
    localparam [31:0] LAST_X = COLUMNS - 1;
    localparam [31:0] LAST_Y = ROWS - 1;
    localparam [31:0] FIRST_X = COLUMNS - QUAD_COLUMNS;
    localparam [31:0] FIRST_Y = ROWS - QUAD_ROWS;
    localparam [X_WIDTH-1:0] LAST_COLUMN = LAST_X[X_WIDTH-1:0];
    localparam [Y_WIDTH-1:0] LAST_ROW = LAST_Y[Y_WIDTH-1:0];
    localparam [X_WIDTH-1:0] FIRST_RIGHT = FIRST_X[X_WIDTH-1:0]; // that completes a pair
    localparam [Y_WIDTH-1:0] FIRST_LOWER = FIRST_Y[Y_WIDTH-1:0];

    // ---- Place of the taxel: its column, its mirror image, and the quads' row
    reg [X_WIDTH-1:0] column;
    reg [Y_WIDTH-1:0] row;
    wire [X_WIDTH-1:0] opposite = LAST_COLUMN - column;
    wire right_half = (column >= FIRST_RIGHT);
    wire centre_column = (column == opposite);
    wire lower_half = (row >= FIRST_LOWER);
    wire centre_row = (row == LAST_ROW - row);
    wire taken = in_valid && in_store && advance;
    wire frame_ends = in_valid && in_last && advance;
    wire [ROW_WIDTH-1:0] row_base; // first quad of the row
    wire [31:0] opposite_wide = {{(32-X_WIDTH){1'b0}}, opposite};

    sptfra_quad_rows #(
        .COLUMNS (COLUMNS),
        .ROWS    (ROWS)
    ) quad_rows (
        .clock     (clock),
        .restart   (reset || frame_ends),
        .next_row  (taken && (column == LAST_COLUMN)),
        .row       (row),
        .row_base  (row_base)
    );

    always @(posedge clock) begin
        if (taken) begin
            column <= (column == LAST_COLUMN) ? {X_WIDTH{1'b0}} : column + 1;
            if (column == LAST_COLUMN) begin
                row <= row + 1;
            end
        end
        if (reset || frame_ends) begin
            column <= {X_WIDTH{1'b0}};
            row <= {Y_WIDTH{1'b0}};
        end
    end

    // ---- Stage 1: the row onto its left half
    (* ram_style = "distributed" *) reg signed [STRESS_BITS-1:0] left [0:QUAD_COLUMNS-1];
    wire signed [STRESS_BITS-1:0] partner = centre_column ? in_stress : left[opposite[QUAD_X_WIDTH-1:0]];
    reg [3:1] valid;
    reg [3:1] lasts;
    reg [2:1] lower;
    reg [2:1] centre;
    reg signed [STRESS_BITS:0] even_1;
    reg signed [STRESS_BITS:0] odd_1;
    reg [ROW_WIDTH-1:0] quad_1;

    always @(posedge clock) begin
        if (taken && !right_half) begin
            left[column[QUAD_X_WIDTH-1:0]] <= in_stress;
        end
        if (advance) begin
            even_1 <= {partner[STRESS_BITS-1], partner} + {in_stress[STRESS_BITS-1], in_stress};
            odd_1 <= {partner[STRESS_BITS-1], partner} - {in_stress[STRESS_BITS-1], in_stress};
            quad_1 <= row_base + opposite_wide[ROW_WIDTH-1:0];
            lower[1] <= lower_half;
            centre[1] <= centre_row;
        end
    end

    // ---- Stages 2 and 3: the lower rows onto the upper ones
    wire signed [STRESS_BITS:0] upper_even;
    wire signed [STRESS_BITS:0] upper_odd;
    reg signed [STRESS_BITS:0] even_2;
    reg signed [STRESS_BITS:0] odd_2;
    reg [ROW_WIDTH-1:0] quad_2;
    reg [ROW_WIDTH-1:0] quad_3;

    sptfra_ram #(
        .WIDTH         (2 * STRESS_BITS + 2),
        .DEPTH         (UPPER_DEPTH),
        .ADDRESS_WIDTH (ROW_WIDTH)
    ) upper (
        .clock         (clock),
        .write_enable  (valid[1] && !lower[1] && advance),
        .write_address (quad_1),
        .write_data    ({odd_1, even_1}),
        .read_enable   (advance),
        .read_address  (quad_1),
        .read_data     ({upper_odd, upper_even})
    );

    localparam signed [SUM_BITS-1:0] HALF = DROPPED; // half a step of the result, for the rounding
    wire signed [SUM_BITS-1:0] even_above = centre[2] ? {even_2[STRESS_BITS], even_2}
        : {upper_even[STRESS_BITS], upper_even};
    wire signed [SUM_BITS-1:0] odd_above = centre[2] ? {odd_2[STRESS_BITS], odd_2}
        : {upper_odd[STRESS_BITS], upper_odd};
    wire signed [SUM_BITS-1:0] even_below = {even_2[STRESS_BITS], even_2};
    wire signed [SUM_BITS-1:0] odd_below = {odd_2[STRESS_BITS], odd_2};
    reg signed [SUM_BITS-1:0] sum_0;
    reg signed [SUM_BITS-1:0] sum_1;
    reg signed [SUM_BITS-1:0] sum_2;
    reg signed [SUM_BITS-1:0] sum_3;
    reg bank;

    always @(posedge clock) begin
        if (advance) begin
            valid <= {valid[2] && lower[2], valid[1], in_valid && in_store && right_half};
            lasts <= {lasts[2:1], in_valid && in_last};
            lower[2] <= lower[1];
            centre[2] <= centre[1];
            even_2 <= even_1;
            odd_2 <= odd_1;
            quad_2 <= quad_1;
            quad_3 <= quad_2;
            sum_0 <= even_above + even_below + HALF;
            sum_1 <= odd_above + odd_below + HALF;
            sum_2 <= even_above - even_below + HALF;
            sum_3 <= odd_above - odd_below + HALF;
        end
        if (frame_written) begin
            bank <= !bank;
        end
        if (reset) begin
            valid <= 3'd0;
            lasts <= 3'd0;
            bank <= 1'b0;
        end
    end

    assign write_valid = valid[3];
    assign write_bank = bank;
    assign write_quad = quad_3;
    assign frame_written = lasts[3] && advance;

    wire [4*SUM_BITS-1:0] sums = {sum_3, sum_2, sum_1, sum_0};
    genvar parity;
    genvar place;
    generate
        for (parity = 0; parity < 4; parity = parity + 1) begin : gen_classes
            for (place = 0; place < DATA_BITS; place = place + 1) begin : gen_bits
                localparam OF_SUM = (place + DROPPED < SUM_BITS) ? place + DROPPED : SUM_BITS - 1;

                assign write_data[DATA_BITS*parity+place] = sums[SUM_BITS*parity+OF_SUM];
            end
        end
    endgenerate

    sptfra_check_latency #(
        .CYCLES (LAST_TO_WRITTEN)
    ) check_latency (
        .clock (clock),
        .reset (reset || !advance),
        .start (in_valid && in_last),
        .done  (frame_written)
    );

    wire _unused = &{1'b0, sums, opposite_wide};

endmodule

`default_nettype wire
