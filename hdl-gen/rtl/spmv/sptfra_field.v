// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The field memory, and the forces as they leave it: f = A+ r + [mu_x |w|, mu_y |w|, -|w|] of every taxel of a folded
// grid.
//
// Written a quad at a time; read taxel by taxel in the order of the output, component after component. Two frames of
// A_p r, four of |w|, which is there long before it is needed. From step to force: 6 cycles.

`default_nettype none

module sptfra_field #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of A_p r and of |w|: up to 27, or up to 35 by two multipliers
    parameter DATA_BITS = 27,
    // Left shifts of A_p r, and of |w| times a friction component, to the step of the force
    parameter FORCE_SHIFT = 0,
    parameter SHARE_SHIFT = 0,
    // Derived
    parameter QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3
) (
    input  wire clock,
    input  wire reset,
    // Weights, from We
    input  wire weights_valid,
    input  wire [ROW_WIDTH-1:0] weights_row,
    input  wire [4*DATA_BITS-1:0] weights,
    input  wire coefficients_complete, // the weights' bank changes
    // A_p r, unfolded
    input  wire [2:0] taxel_force,
    input  wire [ROW_WIDTH-1:0] taxel_row,
    input  wire [4*DATA_BITS-1:0] taxels,
    input  wire taxel_last,
    output reg  complete, // one cycle: a frame's field is there
    // To the output: after rewind, the first taxel's x; after each step, the next one
    input  wire enable,
    input  wire rewind,
    input  wire step,
    input  wire release_frame, // the banks read are free again
    input  wire signed [17:0] mu_x, // of the frame that is read, held
    input  wire signed [17:0] mu_y,
    output wire signed [63:0] force_value
);

    generate
        if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
            sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
        end
        if (DATA_BITS > 35) begin : gen_check_data
            sptfra_error_data_bits_must_be_up_to_35 invalid ();
        end
    endgenerate

    localparam FACTOR_BITS = (DATA_BITS > 27) ? 35 : 27;
    localparam PRODUCT_BITS = FACTOR_BITS + 18;
    localparam FORCE_DEPTH = 6 * QUADS;
    localparam FORCE_WIDTH = $clog2(FORCE_DEPTH);
    localparam QUAD_COLUMNS = (COLUMNS + 1) / 2;
    localparam QUAD_ROWS = (ROWS + 1) / 2;
    localparam X_WIDTH = $clog2(COLUMNS);
    localparam Y_WIDTH = $clog2(ROWS);
    localparam [31:0] LENGTH = QUADS;
    localparam signed [17:0] ONE = 18'sd65536; // friction has 16 fraction bits

    // ---- Write
    wire is_force = (taxel_force != 3'd0);
    wire [31:0] write_part = taxel_force[0] ? 0 : taxel_force[1] ? LENGTH : 2 * LENGTH;
    wire [31:0] write_row = {{(32-ROW_WIDTH){1'b0}}, taxel_row};
    reg fill_bank;
    reg [1:0] weight_fill_bank;
    wire [31:0] write_base = fill_bank ? write_part + 3 * LENGTH : write_part;

    always @(posedge clock) begin
        complete <= is_force && taxel_last;
        if (is_force && taxel_last) begin
            fill_bank <= !fill_bank;
        end
        if (coefficients_complete) begin
            weight_fill_bank <= weight_fill_bank + 2'd1;
        end
        if (reset) begin
            complete <= 1'b0;
            fill_bank <= 1'b0;
            weight_fill_bank <= 2'd0;
        end
    end

    // ---- Read: which taxel, of which quad
    localparam [31:0] LAST_X = COLUMNS - 1;
    localparam [31:0] LEFT_X = QUAD_COLUMNS - 1;
    localparam [31:0] UPPER_Y = QUAD_ROWS - 1;
    localparam [X_WIDTH-1:0] LAST_COLUMN = LAST_X[X_WIDTH-1:0];
    localparam [X_WIDTH-1:0] LAST_LEFT = LEFT_X[X_WIDTH-1:0];
    localparam [Y_WIDTH-1:0] LAST_UPPER = UPPER_Y[Y_WIDTH-1:0];
    reg read_bank;
    reg [1:0] weight_read_bank;
    reg [1:0] p; // component: 0 x, 1 y, 2 z
    reg [X_WIDTH-1:0] column;
    reg last_column;
    reg [Y_WIDTH-1:0] row;
    reg [1:0] p_1;
    reg [1:0] member_1;
    reg [1:0] p_2;
    reg [1:0] member_2;
    reg [1:0] p_3;
    reg [1:0] member_3;
    reg [FORCE_WIDTH-1:0] force_address_1;
    reg [ROW_WIDTH+1:0] weight_address_1;
    wire [X_WIDTH-1:0] next_column = last_column ? {X_WIDTH{1'b0}} : column + 1;
    wire mirrored_x = (column > LAST_LEFT);
    wire mirrored_y = (row > LAST_UPPER);
    wire [X_WIDTH-1:0] quad_x = mirrored_x ? LAST_COLUMN - column : column;
    wire [ROW_WIDTH-1:0] row_base; // first quad of the row
    wire [31:0] quad_x_wide = {{(32-X_WIDTH){1'b0}}, quad_x};
    wire [ROW_WIDTH-1:0] quad = row_base + quad_x_wide[ROW_WIDTH-1:0];
    wire [31:0] read_part = (p == 2'd0) ? 0 : (p == 2'd1) ? LENGTH : 2 * LENGTH;
    wire [31:0] read_base = read_bank ? read_part + 3 * LENGTH : read_part;
    wire [31:0] read_row = {{(32-ROW_WIDTH){1'b0}}, quad};

    sptfra_quad_rows #(
        .COLUMNS (COLUMNS),
        .ROWS    (ROWS)
    ) quad_rows (
        .clock    (clock),
        .restart  (rewind),
        .next_row (step && p[1] && last_column),
        .row      (row),
        .row_base (row_base)
    );

    always @(posedge clock) begin
        if (enable) begin
            p_1 <= p;
            member_1 <= {mirrored_y, mirrored_x};
            force_address_1 <= read_base[FORCE_WIDTH-1:0] + read_row[FORCE_WIDTH-1:0];
            weight_address_1 <= {weight_read_bank, quad};
            p_2 <= p_1;
            member_2 <= member_1;
            p_3 <= p_2;
            member_3 <= member_2;
        end
        if (step) begin
            p <= p[1] ? 2'd0 : p + 2'd1;
            if (p[1]) begin
                column <= next_column;
                last_column <= (next_column == LAST_COLUMN);
                if (last_column) begin
                    row <= row + 1;
                end
            end
        end
        if (rewind) begin
            p <= 2'd0;
            column <= {X_WIDTH{1'b0}};
            last_column <= 1'b0; // there are two columns at least
            row <= {Y_WIDTH{1'b0}};
        end
        if (release_frame) begin
            read_bank <= !read_bank;
            weight_read_bank <= weight_read_bank + 2'd1;
        end
        if (reset) begin
            read_bank <= 1'b0;
            weight_read_bank <= 2'd0;
        end
    end

    // ---- A memory for each member of the quads
    wire signed [DATA_BITS-1:0] force_of [0:3];
    wire signed [DATA_BITS-1:0] weight_of [0:3];
    genvar index;
    generate
        for (index = 0; index < 4; index = index + 1) begin : gen_members
            wire signed [DATA_BITS-1:0] force_2;
            wire signed [DATA_BITS-1:0] weight_2;
            reg signed [DATA_BITS-1:0] force_3;
            reg signed [DATA_BITS-1:0] weight_3;

            always @(posedge clock) begin
                if (enable) begin
                    force_3 <= force_2;
                    weight_3 <= weight_2;
                end
            end

            assign force_of[index] = force_3;
            assign weight_of[index] = weight_3;

            sptfra_ram #(
                .WIDTH         (DATA_BITS),
                .DEPTH         (FORCE_DEPTH),
                .ADDRESS_WIDTH (FORCE_WIDTH)
            ) forces (
                .clock         (clock),
                .write_enable  (is_force),
                .write_address (write_base[FORCE_WIDTH-1:0] + write_row[FORCE_WIDTH-1:0]),
                .write_data    (taxels[DATA_BITS*index +: DATA_BITS]),
                .read_enable   (enable),
                .read_address  (force_address_1),
                .read_data     (force_2)
            );

            sptfra_ram #(
                .WIDTH         (DATA_BITS),
                .DEPTH         (4 << ROW_WIDTH),
                .ADDRESS_WIDTH (ROW_WIDTH + 2)
            ) quad_weights (
                .clock         (clock),
                .write_enable  (weights_valid),
                .write_address ({weight_fill_bank, weights_row}),
                .write_data    (weights[DATA_BITS*index +: DATA_BITS]),
                .read_enable   (enable),
                .read_address  (weight_address_1),
                .read_data     (weight_2)
            );
        end
    endgenerate

    // ---- Stage 4: the weight's share of this component; stage 5: both; stage 6: the force
    reg signed [17:0] share_4;
    reg signed [DATA_BITS-1:0] weight_4;
    reg signed [DATA_BITS-1:0] force_4;
    reg signed [DATA_BITS-1:0] force_5;
    reg signed [63:0] force_6;
    wire signed [FACTOR_BITS-1:0] weight_wide;
    wire signed [PRODUCT_BITS-1:0] product_low_5; // the product is their sum
    wire signed [PRODUCT_BITS-1:0] product_high_5;
    wire signed [63:0] force_wide = {{(64-DATA_BITS){force_5[DATA_BITS-1]}}, force_5};
    wire signed [63:0] product_low = {{(64-PRODUCT_BITS){product_low_5[PRODUCT_BITS-1]}}, product_low_5};
    wire signed [63:0] product_high = {{(64-PRODUCT_BITS){product_high_5[PRODUCT_BITS-1]}}, product_high_5};
    genvar place;
    generate
        for (place = 0; place < FACTOR_BITS; place = place + 1) begin : gen_weight
            assign weight_wide[place] = weight_4[(place < DATA_BITS) ? place : DATA_BITS - 1];
        end
    endgenerate

    sptfra_multiply #(
        .WIDE (DATA_BITS > 27)
    ) multiplier (
        .clock       (clock),
        .enable      (enable),
        .coefficient (share_4),
        .data        (weight_wide),
        .low         (product_low_5),
        .high        (product_high_5)
    );

    assign force_value = force_6;

    always @(posedge clock) begin
        if (enable) begin
            case (p_3)
                2'd0: share_4 <= mu_x;
                2'd1: share_4 <= mu_y;
                default: share_4 <= -ONE;
            endcase
            weight_4 <= weight_of[member_3];
            force_4 <= force_of[member_3];
            force_5 <= force_4;
            force_6 <= (force_wide <<< FORCE_SHIFT) + (product_low <<< SHARE_SHIFT) + (product_high <<< SHARE_SHIFT);
        end
    end

    wire _unused = &{1'b0, write_base, write_row, quad_x_wide, read_base, read_row};

endmodule

`default_nettype wire
