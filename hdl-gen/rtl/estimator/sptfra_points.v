// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Condition 1 at every point of the (mu_x, mu_y) plane at once: B = sum max(0, u0 + mu_x u1 + mu_y u2), SIDE x SIDE
// points 3/16 apart, a cell a point.
//
// A taxel a cycle, or two: a cell adds X of its column and Y of its row, and accumulates what is above zero; a sum that
// leaves its width is the largest number. From start to the first row of points: four cycles a quad, and 13, or two a
// quad, and 14; then a row a cycle. The rows stay until the next start, and each can be asked for again.

`default_nettype none

module sptfra_points #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of a quad
    parameter integer ROW_WIDTH = 5,
    // Points along an axis, odd
    parameter integer SIDE = 15,
    // Taxels a cycle: 1 or 2
    parameter integer TAXELS = 1,
    // Left shift of u before the right shift by the bits of sum |b|
    parameter integer U_LEFT = 24,
    // From start to the first row, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // u_q of a quad's taxels, member 0 in the lowest bits
    input  wire [2:0] u_valid,
    input  wire [ROW_WIDTH-1:0] u_quad,
    input  wire [4*DATA_BITS-1:0] u_values,
    input  wire fill_bank,
    input  wire search_bank,
    // Start, with these held from the next cycle on
    input  wire start,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest, // max |b|
    // 2^-8 sum |b|, in the steps of B
    output wire [15:0] margin,
    // All of a quad as it is read, u_0 in the lowest bits
    output reg  read_valid,
    output reg  [ROW_WIDTH-1:0] read_quad,
    output reg  [3*4*27-1:0] read_values,
    // B, a row of points at a time, mu_x from the least one on in the lowest bits; held until the next one
    output reg  row_valid,
    input  wire again, // after the last row: the first one once more, three cycles later, and so on
    output reg  [SIDE*28-1:0] row_values,
    output wire clipped // a u was; held until the next start
);

    localparam integer QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2);
    localparam integer LAST_QUAD = QUADS - 1;
    localparam integer VALUE_BITS = 28;
    localparam integer POINT_BITS = 27;
    localparam integer TENSION_BITS = POINT_BITS - 2 + TAXELS; // of the taxels of a cycle
    localparam integer STAGES = 10 + TAXELS; // from a taxel's address to its tension being added to the sums
    localparam [1:0] STEP = TAXELS[1:0];
    localparam [1:0] LAST_MEMBER = 2'd0 - STEP;
    localparam [3:0] LAST_ROW = SIDE[3:0] - 4'd1;

    generate
        if ((TAXELS != 1) && (TAXELS != 2)) begin : gen_check
            sptfra_error_one_or_two_taxels_a_cycle invalid ();
        end
    endgenerate

    // ---- Taxels: the members of a quad one after the other, or two. Index k: k cycles after the address
    reg reading;
    reg [ROW_WIDTH-1:0] quad;
    reg [1:0] member;
    reg [1:0] member_1;
    reg [1:0] member_2;
    wire last_taxel = (quad == LAST_QUAD[ROW_WIDTH-1:0]) && (member == LAST_MEMBER);
    reg [STAGES:1] valids;
    reg [STAGES:1] lasts;
    wire [3*4*27-1:0] quad_1;
    wire [3*4*27-1:0] quad_2 = read_values; // a register behind the memory, then the choice
    wire [TAXELS*3*27-1:0] taxels_2;
    reg [TAXELS*3*27-1:0] taxels_3;

    sptfra_taxel_memory #(
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .DATA_BITS (DATA_BITS),
        .ROW_WIDTH (ROW_WIDTH)
    ) taxels (
        .clock       (clock),
        .u_valid     (u_valid),
        .fill_bank   (fill_bank),
        .u_quad      (u_quad),
        .u_values    (u_values),
        .read_bank   (search_bank),
        .read_quad   (quad),
        .read_values (quad_1)
    );

    always @(posedge clock) begin
        if (reading) begin
            member <= member + STEP;
            quad <= (member == LAST_MEMBER) ? quad + 1'b1 : quad;
        end
        if (reading && last_taxel) begin
            reading <= 1'b0;
        end
        if (start) begin
            reading <= 1'b1;
            quad <= {ROW_WIDTH{1'b0}};
            member <= 2'd0;
        end
        member_1 <= member;
        member_2 <= member_1;
        taxels_3 <= taxels_2;
        read_valid <= valids[1] && (member_1 == 2'd0);
        read_quad <= quad; // of the same: it is read for two cycles at least
        read_values <= quad_1;
        valids <= {valids[STAGES-1:1], reading};
        lasts <= {lasts[STAGES-1:1], reading && last_taxel};
        if (reset) begin
            reading <= 1'b0;
            valids <= {STAGES{1'b0}};
            lasts <= {STAGES{1'b0}};
            read_valid <= 1'b0;
        end
    end

    // ---- Their parts in each column and in each row of points
    wire [TAXELS*SIDE*27-1:0] along_x_9;
    wire [TAXELS*SIDE*27-1:0] along_y_9;
    wire [TAXELS*16-1:0] margins;
    wire [TAXELS-1:0] clips;

    assign margin = margins[15:0];
    assign clipped = (clips != {TAXELS{1'b0}});

    genvar index;
    genvar column;
    genvar taxel;

    generate
        for (taxel = 0; taxel < TAXELS; taxel = taxel + 1) begin : gen_taxels
            localparam [1:0] MEMBER = taxel;
            wire [1:0] of_quad_2 = member_2 | MEMBER;

            for (index = 0; index < 3; index = index + 1) begin : gen_select
                wire [4*27-1:0] of_q = quad_2[4*27*index +: 4*27];

                assign taxels_2[27*(3*taxel + index) +: 27] = of_q[27*of_quad_2 +: 27];
            end

            sptfra_points_taxel #(
                .SIDE   (SIDE),
                .U_LEFT (U_LEFT)
            ) parts (
                .clock      (clock),
                .reset      (reset),
                .start      (start),
                .stress_sum (stress_sum),
                .largest    (largest),
                .margin     (margins[16*taxel +: 16]),
                .valid      (valids[3]),
                .u0         (taxels_3[27*(3*taxel + 0) +: 27]),
                .u1         (taxels_3[27*(3*taxel + 1) +: 27]),
                .u2         (taxels_3[27*(3*taxel + 2) +: 27]),
                .along_x    (along_x_9[SIDE*27*taxel +: SIDE*27]),
                .along_y    (along_y_9[SIDE*27*taxel +: SIDE*27]),
                .clipped    (clips[taxel])
            );
        end
    endgenerate

    // ---- Cells, a point each: the tension, and its sum with a bit that stays once it has overflowed. A sum begins
    // with its register's reset. For a row to leave, all move down by one, through the cells' own adders, and what was
    // in row 0 goes to the last one: there is no choice among rows, and no memory of them
    reg giving;
    reg [3:0] row;
    reg turn; // this cycle
    reg turn_next;
    reg count_next;
    reg nothing_8;
    wire turn_after_next = lasts[STAGES-1] || lasts[STAGES] || (giving && (row < LAST_ROW - 4'd1)) || again;
    wire [(SIDE+1)*SIDE*(VALUE_BITS+1)-1:0] sums; // row 0 above the last row once more

    assign sums[SIDE*SIDE*(VALUE_BITS+1) +: SIDE*(VALUE_BITS+1)] = sums[0 +: SIDE*(VALUE_BITS+1)];

    generate
        for (index = 0; index < SIDE; index = index + 1) begin : gen_rows
            for (column = 0; column < SIDE; column = column + 1) begin : gen_points
                // For each point its own: a tool puts a row's points where there is room, all over a device
                (* keep = "true" *) reg clears; // a frame begins
                (* keep = "true" *) reg nothing; // no taxel is there
                (* keep = "true" *) reg counts; // a tension, or the row above, is taken
                (* keep = "true" *) reg turns; // the row above
                wire [TAXELS*(POINT_BITS-1)-1:0] tensions_11;
                wire [TENSION_BITS-1:0] tension; // of all taxels of a cycle; none in a turn
                wire [VALUE_BITS:0] above = sums[(VALUE_BITS+1)*(SIDE*(index + 1) + column) +: VALUE_BITS+1];
                reg [VALUE_BITS-1:0] sum;
                reg over;
                wire [VALUE_BITS:0] next = { {(VALUE_BITS + 1 - TENSION_BITS){1'b0}}, tension}
                    + {1'b0, turns ? above[VALUE_BITS-1:0] : sum};

                for (taxel = 0; taxel < TAXELS; taxel = taxel + 1) begin : gen_tensions
                    wire signed [POINT_BITS-1:0] x = along_x_9[27*(SIDE*taxel + column) +: 27];
                    wire signed [POINT_BITS-1:0] y = along_y_9[27*(SIDE*taxel + index) +: 27];
                    wire signed [POINT_BITS-1:0] stress = x + y;
                    reg presses_10;
                    reg [POINT_BITS-2:0] stress_10;
                    reg [POINT_BITS-2:0] tension_11;

                    // The sign waits in a register of its own: it resets 26
                    always @(posedge clock) begin
                        presses_10 <= stress[POINT_BITS-1];
                        if (nothing) begin
                            presses_10 <= 1'b1;
                        end
                        stress_10 <= stress[POINT_BITS-2:0];
                        tension_11 <= stress_10;
                        if (presses_10) begin
                            tension_11 <= {(POINT_BITS - 1){1'b0}};
                        end
                    end

                    assign tensions_11[(POINT_BITS-1)*taxel +: POINT_BITS-1] = tension_11;
                end

                if (TAXELS == 1) begin : gen_one
                    assign tension = tensions_11;
                end else begin : gen_both
                    reg [TENSION_BITS-1:0] both_12;

                    always @(posedge clock) begin
                        both_12 <= {1'b0, tensions_11[0 +: POINT_BITS-1]}
                            + {1'b0, tensions_11[(TAXELS-1)*(POINT_BITS-1) +: POINT_BITS-1]};
                    end

                    assign tension = both_12;
                end

                always @(posedge clock) begin
                    clears <= start;
                    nothing <= nothing_8;
                    counts <= count_next;
                    turns <= turn_next;
                    if (clears) begin
                        sum <= {VALUE_BITS{1'b0}};
                        over <= 1'b0;
                    end else if (counts) begin
                        sum <= next[VALUE_BITS-1:0];
                        over <= next[VALUE_BITS] || (turns ? above[VALUE_BITS] : over);
                    end
                end

                assign sums[(VALUE_BITS+1)*(SIDE*index + column) +: VALUE_BITS+1] = {over, sum};
            end
        end
    endgenerate

    // ---- Rows, when all taxels are in
    always @(posedge clock) begin
        turn_next <= turn_after_next;
        count_next <= valids[STAGES-2] || turn_after_next;
        nothing_8 <= !valids[7];
        turn <= turn_next;
        if (giving) begin
            row <= row + 4'd1;
        end
        if (giving && (row == LAST_ROW)) begin
            giving <= 1'b0;
        end
        if (lasts[STAGES]) begin
            giving <= 1'b1;
            row <= 4'd0;
        end
        row_valid <= giving;
        if (reset) begin
            turn_next <= 1'b0;
            giving <= 1'b0;
            row_valid <= 1'b0;
        end
    end

    generate
        for (column = 0; column < SIDE; column = column + 1) begin : gen_values
            wire [VALUE_BITS:0] of_column = sums[(VALUE_BITS+1)*column +: VALUE_BITS+1];

            always @(posedge clock) begin
                if (turn) begin
                    row_values[VALUE_BITS*column +: VALUE_BITS] <= of_column[VALUE_BITS-1:0]
                        | {VALUE_BITS{of_column[VALUE_BITS]}};
                end
            end
        end
    endgenerate

`ifdef SIMULATION
    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (row_valid)
    );
`else
    wire _unused_check = (EXPECTED_LATENCY != 0);
`endif

    wire _unused = &{1'b0, margins};

endmodule

`default_nettype wire
