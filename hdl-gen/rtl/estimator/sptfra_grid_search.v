// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Grid search: Condition 1 at 13 x 13 values of (mu_x, mu_y), 1/4 apart, and the centroid of its level set.
//
// B = sum max(0, u0 + mu_x u1 + mu_y u2) over all taxels. An evaluator adds X of its column and Y of its row, and
// accumulates what is above zero. A sum beyond its width stays the largest number.
//
//   PARALLEL  evaluators               start to first row  next row        start to done
//   169       one a point              4 Q + 13            1 cycle         4 Q + 101
//             ... two taxels a cycle   2 Q + 14            1 cycle         2 Q + 77
//   13        one a column, row after  4 Q + 13            4 Q + 1 cycles  52 Q + 101
//             row of the grid
//
// Q: orbits. Each row can be read again until the next start.

`default_nettype none

module sptfra_grid_search #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of an orbit
    parameter integer ROW_WIDTH = 5,
    // Points evaluated at a time: all 169, or a row of 13
    parameter integer PARALLEL = 169,
    // Taxels a cycle: 1, or 2 with all points at a time, whose rows are then weighed in one cycle each
    parameter integer TAXELS = 1,
    // Bits of a value below the leading bit of sum |b|
    parameter integer FRACTION = 21,
    // Left shift of u before the right shift by the bits of sum |b|
    parameter integer U_LEFT = 22,
    // Checked in simulation, 0: unchecked: cycles from the start to the first row of points
    parameter integer EXPECTED_VALUES_LATENCY = 0,
    // ... to the centroid
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // u_q of an orbit's taxels, image 0 in the lowest bits
    input  wire [2:0] u_valid,
    input  wire [ROW_WIDTH-1:0] u_orbit,
    input  wire [4*DATA_BITS-1:0] u_values,
    input  wire fill_bank,
    input  wire search_bank,
    // Start, with these held from the next cycle on
    input  wire start,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest, // max |b|
    // All of an orbit as it is first read, u_0 in the lowest bits
    output reg  read_valid,
    output reg  [ROW_WIDTH-1:0] read_orbit,
    output reg  [3*4*27-1:0] read_values,
    // Result, held until the next start
    output wire done, // one cycle
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    output wire unknown, // nothing limits the friction
    output wire at_bound, // the least value lies on the border
    output wire saturated // a u was clipped
);

    localparam integer ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2);
    localparam integer LAST_ORBIT = ORBITS - 1;
    localparam integer SIDE = 13; // points along an axis
    localparam integer AT_ONCE = PARALLEL / SIDE; // rows of the grid
    localparam integer IS_SERIAL = (AT_ONCE == 1) ? 1 : 0;
    localparam integer X_BITS = FRACTION + 3;
    localparam integer Y_BITS = FRACTION + 2;
    localparam integer VALUE_BITS = FRACTION + 2;
    localparam integer MARGIN_BITS = FRACTION - 7;
    localparam integer STAGES = 10 + TAXELS; // from a taxel's address to its tension being added to the sums
    localparam [1:0] STEP = TAXELS[1:0];
    localparam [1:0] LAST_IMAGE = 2'd0 - STEP;
    localparam [3:0] LAST_ROW = SIDE[3:0] - 4'd1;

    if ((FRACTION < 20) || (FRACTION > 24)) begin : gen_check_fraction
        sptfra_error_a_value_has_20_to_24_bits_of_fraction invalid ();
    end
    if ((TAXELS != 1) && ((TAXELS != 2) || (IS_SERIAL != 0))) begin : gen_check_taxels
        sptfra_error_one_taxel_a_cycle_or_two_with_all_points invalid ();
    end
    if ((PARALLEL != SIDE) && (PARALLEL != SIDE * SIDE)) begin : gen_check_parallel
        sptfra_error_a_row_of_points_at_a_time_or_all_of_them invalid ();
    end

    // ---- Taxels: the images of an orbit one after the other, or two. Index k: k cycles after the address
    reg reading;
    reg pausing; // a cycle from one row of the grid to the next
    reg [3:0] pass; // serial: the row of the grid
    reg [ROW_WIDTH-1:0] orbit;
    reg [1:0] image;
    reg [1:0] image_1;
    reg [1:0] image_2;
    wire last_taxel = (orbit == LAST_ORBIT[ROW_WIDTH-1:0]) && (image == LAST_IMAGE);
    reg [STAGES:1] valids;
    reg [STAGES:1] lasts;
    wire [3*4*27-1:0] orbit_1;
    wire [3*4*27-1:0] orbit_2 = read_values; // a register behind the memory, then the choice
    wire [TAXELS*3*27-1:0] taxels_2;
    reg [TAXELS*3*27-1:0] taxels_3;

    sptfra_taxel_memory #(
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .DATA_BITS (DATA_BITS),
        .ROW_WIDTH (ROW_WIDTH)
    ) taxels (
        .clock       (clock),
        .reset       (reset),
        .u_valid     (u_valid),
        .fill_bank   (fill_bank),
        .u_orbit     (u_orbit),
        .u_values    (u_values),
        .read_bank   (search_bank),
        .read_orbit  (orbit),
        .read_values (orbit_1)
    );

    always @(posedge clock) begin
        if (reading) begin
            image <= image + STEP;
            orbit <= (image == LAST_IMAGE) ? orbit + 1'b1 : orbit;
        end
        if (reading && last_taxel) begin
            reading <= 1'b0;
            pausing <= (IS_SERIAL != 0) && (pass != LAST_ROW);
        end
        if (pausing) begin
            pausing <= 1'b0;
            reading <= 1'b1;
            pass <= pass + 4'd1;
        end
        if (pausing || start) begin
            orbit <= {ROW_WIDTH{1'b0}};
            image <= 2'd0;
        end
        if (start) begin
            reading <= 1'b1;
            pausing <= 1'b0;
            pass <= 4'd0;
        end
        image_1 <= image;
        image_2 <= image_1;
        taxels_3 <= taxels_2;
        read_valid <= valids[1] && (image_1 == 2'd0) && (pass == 4'd0);
        read_orbit <= orbit; // of the same: it is read for two cycles at least
        read_values <= orbit_1;
        valids <= {valids[STAGES-1:1], reading};
        lasts <= {lasts[STAGES-1:1], reading && last_taxel};
        if (reset) begin
            reading <= 1'b0;
            pausing <= 1'b0;
            valids <= {STAGES{1'b0}};
            lasts <= {STAGES{1'b0}};
            read_valid <= 1'b0;
        end
    end

    // ---- Their terms in each column and row of the grid
    wire [TAXELS*SIDE*X_BITS-1:0] along_x_9;
    wire [TAXELS*AT_ONCE*Y_BITS-1:0] along_y_9;
    wire [TAXELS*MARGIN_BITS-1:0] margins; // of the level set
    wire [TAXELS-1:0] clips;
    reg [3:0] pass_8; // of the terms that are formed

    assign saturated = (clips != {TAXELS{1'b0}});

    genvar index;
    genvar column;
    genvar taxel;

    always @(posedge clock) begin
        if (lasts[8]) begin
            pass_8 <= pass_8 + 4'd1;
        end
        if (start) begin
            pass_8 <= 4'd0;
        end
    end

    for (taxel = 0; taxel < TAXELS; taxel = taxel + 1) begin : gen_taxels
        localparam [1:0] IMAGE = taxel;
        wire [1:0] of_orbit_2 = image_2 | IMAGE;

        for (index = 0; index < 3; index = index + 1) begin : gen_select
            wire [4*27-1:0] of_q = orbit_2[4*27*index +: 4*27];

            assign taxels_2[27*(3*taxel + index) +: 27] = of_q[27*of_orbit_2 +: 27];
        end

        sptfra_grid_terms #(
            .SIDE     (SIDE),
            .AT_ONCE  (AT_ONCE),
            .FRACTION (FRACTION),
            .U_LEFT   (U_LEFT)
        ) terms (
            .clock      (clock),
            .reset      (reset),
            .start      (start),
            .stress_sum (stress_sum),
            .largest    (largest),
            .margin     (margins[MARGIN_BITS*taxel +: MARGIN_BITS]),
            .valid      (valids[3]),
            .u0         (taxels_3[27*(3*taxel + 0) +: 27]),
            .u1         (taxels_3[27*(3*taxel + 1) +: 27]),
            .u2         (taxels_3[27*(3*taxel + 2) +: 27]),
            .row        (pass_8),
            .along_x    (along_x_9[SIDE*X_BITS*taxel +: SIDE*X_BITS]),
            .along_y    (along_y_9[AT_ONCE*Y_BITS*taxel +: AT_ONCE*Y_BITS]),
            .clipped    (clips[taxel])
        );
    end

    // ---- Evaluators. With one for each point, all rows move down by one for a row to leave, through the evaluators'
    // own adders, and row 0 goes to the last one: no choice among rows, and no memory of them
    reg giving;
    reg [3:0] row;
    reg turn; // this cycle
    reg turn_next;
    reg count_next;
    reg nothing_8;
    reg all_given;
    wire again; // after the last row: the first one once more, three cycles later, and so on
    wire turn_after_next = again || lasts[STAGES-1]
        || ((IS_SERIAL == 0) && (lasts[STAGES] || (giving && (row < LAST_ROW - 4'd1))));
    wire [AT_ONCE*SIDE*(VALUE_BITS+1)-1:0] sums;

    for (index = 0; index < AT_ONCE; index = index + 1) begin : gen_rows
        for (column = 0; column < SIDE; column = column + 1) begin : gen_points
            // Row 0 follows on the last one
            localparam integer ABOVE = ((index == AT_ONCE - 1) ? 0 : SIDE*(index + 1)) + column;
            wire [TAXELS*X_BITS-1:0] x;
            wire [TAXELS*Y_BITS-1:0] y;

            for (taxel = 0; taxel < TAXELS; taxel = taxel + 1) begin : gen_terms
                assign x[X_BITS*taxel +: X_BITS] = along_x_9[X_BITS*(SIDE*taxel + column) +: X_BITS];
                assign y[Y_BITS*taxel +: Y_BITS] = along_y_9[Y_BITS*(AT_ONCE*taxel + index) +: Y_BITS];
            end

            sptfra_grid_point #(
                .TAXELS     (TAXELS),
                .X_BITS     (X_BITS),
                .VALUE_BITS (VALUE_BITS)
            ) point (
                .clock   (clock),
                .clear   (start || ((IS_SERIAL != 0) && lasts[STAGES])),
                .nothing (nothing_8),
                .count   (count_next),
                .turn    (turn_next && (IS_SERIAL == 0)),
                .x       (x),
                .y       (y),
                .above   (sums[(VALUE_BITS+1)*ABOVE +: VALUE_BITS+1]),
                .sum     (sums[(VALUE_BITS+1)*(SIDE*index + column) +: VALUE_BITS+1])
            );
        end
    end

    // ---- Rows, when all taxels are in
    reg row_valid;
    reg [SIDE*VALUE_BITS-1:0] row_values; // of the least mu_x in the lowest bits, held until the next row

    always @(posedge clock) begin
        turn_next <= turn_after_next;
        count_next <= valids[STAGES-2] || (turn_after_next && (IS_SERIAL == 0));
        nothing_8 <= !valids[7];
        turn <= turn_next;
        if (giving || (turn && all_given)) begin
            row <= (row == LAST_ROW) ? 4'd0 : row + 4'd1;
        end
        if (giving && ((row == LAST_ROW) || (IS_SERIAL != 0))) begin
            giving <= 1'b0;
        end
        if (giving && (row == LAST_ROW)) begin
            all_given <= 1'b1;
        end
        if (lasts[STAGES]) begin
            giving <= 1'b1;
        end
        if (start) begin
            row <= 4'd0;
            all_given <= 1'b0;
        end
        row_valid <= giving;
        if (reset) begin
            turn_next <= 1'b0;
            giving <= 1'b0;
            row_valid <= 1'b0;
        end
    end

    wire [SIDE*(VALUE_BITS+1)-1:0] row_0 = sums[SIDE*(VALUE_BITS+1)-1:0];
    wire [SIDE*(VALUE_BITS+1)-1:0] row_next;

    if (IS_SERIAL != 0) begin : gen_memory
        (* ram_style = "distributed" *) reg [SIDE*(VALUE_BITS+1)-1:0] memory [0:15];

        always @(posedge clock) begin
            if (giving) begin
                memory[row] <= row_0;
            end
        end

        assign row_next = all_given ? memory[row] : row_0;
    end else begin : gen_none
        assign row_next = row_0;
    end

    for (column = 0; column < SIDE; column = column + 1) begin : gen_values
        wire [VALUE_BITS:0] of_column = row_next[(VALUE_BITS+1)*column +: VALUE_BITS+1];

        always @(posedge clock) begin
            if (turn) begin
                row_values[VALUE_BITS*column +: VALUE_BITS] <= of_column[VALUE_BITS-1:0];
                if (of_column[VALUE_BITS]) begin
                    row_values[VALUE_BITS*column +: VALUE_BITS] <= {VALUE_BITS{1'b1}};
                end
            end
        end
    end

    // ---- Their level set
    sptfra_grid_level #(
        .SIDE             (SIDE),
        .AT_ONCE          ((TAXELS == 1) ? 5 : SIDE),
        .FRACTION         (FRACTION),
        .EXPECTED_LATENCY (EXPECTED_LATENCY)
    ) level_set (
        .clock      (clock),
        .reset      (reset),
        .start      (start),
        .margin     (margins[MARGIN_BITS-1:0]),
        .row_valid  (row_valid),
        .row_values (row_values),
        .again      (again),
        .done       (done),
        .mu_x       (mu_x),
        .mu_y       (mu_y),
        .unknown    (unknown),
        .at_bound   (at_bound)
    );

    sptfra_check_latency #(
        .CYCLES (EXPECTED_VALUES_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (row_valid)
    );

    wire _unused = &{1'b0, margins};

endmodule

`default_nettype wire
