// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The level set of B, and its centroid: where the friction lies in the (mu_x, mu_y) plane.
//
// The values of B come in the order of the walk and are stored. The level set lies below B_min + 2^-8 sum |b|; a point
// weighs as the square of its depth, so that it weighs nothing at the edge. From the last value to done: 441 points,
// and 34 cycles.

`default_nettype none

module sptfra_level_set #(
    // Bits of a value
    parameter integer VALUE_BITS = 38,
    // Right shift that turns sum |b| into the level above the least value
    parameter integer SHARE_SHIFT = 5,
    // From the last value to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // Start, with the sum held from the next cycle on
    input  wire start,
    input  wire [39:0] stress_sum,
    // From the walk
    input  wire value_valid,
    input  wire [VALUE_BITS-1:0] value,
    // Result, held until the next start
    output wire done, // one cycle
    output wire signed [17:0] mu_x, // 16 fraction bits
    output wire signed [17:0] mu_y,
    output reg  unknown, // nothing limits the friction
    output reg  at_bound // the least B lies on the border
);

    localparam integer REACH = 10; // steps from the middle of the grid to its border
    localparam integer SIDE = 2 * REACH + 1;
    localparam integer POINTS = SIDE * SIDE;
    localparam [8:0] LAST_POINT = POINTS[8:0] - 9'd1;
    localparam [4:0] LAST = SIDE[4:0] - 5'd1; // point of a row, and row
    // Leading bits of the level that a weight is the square of, and bits dropped from the square
    localparam integer DEPTH_BITS = 17;
    localparam integer WEIGHT_DROP = 8;

    localparam [2:0] IDLE = 3'd0, WALK = 3'd1, LEAST = 3'd2, LEVEL = 3'd3, DRAIN = 3'd4, DIVIDE = 3'd5;

    generate
        if ((VALUE_BITS < DEPTH_BITS) || (VALUE_BITS > 47)) begin : gen_check
            sptfra_error_values_must_have_17_to_47_bits invalid ();
        end
    endgenerate

    reg [2:0] state;
    reg [3:0] wait_count;

    // ---- Values as they come, in the order of the walk: stored, and the least ones kept
    reg [8:0] count;
    reg [4:0] along_there;
    reg [4:0] row_there;
    wire border_there = (along_there == 5'd0) || (along_there == LAST) || (row_there == 5'd0) || (row_there == LAST);
    reg [VALUE_BITS-1:0] least_inside;
    reg [VALUE_BITS-1:0] least_on_border;
    reg all_there;

    always @(posedge clock) begin
        all_there <= value_valid && (count == LAST_POINT);
        if (value_valid) begin
            count <= count + 9'd1;
            along_there <= (along_there == LAST) ? 5'd0 : along_there + 5'd1;
            row_there <= (along_there == LAST) ? row_there + 5'd1 : row_there;
            if (border_there && (value < least_on_border)) begin
                least_on_border <= value;
            end
            if (!border_there && (value < least_inside)) begin
                least_inside <= value;
            end
        end
        if (start) begin
            count <= 9'd0;
            along_there <= 5'd0;
            row_there <= 5'd0;
            least_inside <= {VALUE_BITS{1'b1}};
            least_on_border <= {VALUE_BITS{1'b1}};
        end
        if (reset) begin
            all_there <= 1'b0;
        end
    end

    wire [VALUE_BITS-1:0] value_1;
    reg [8:0] address;

    sptfra_ram #(
        .WIDTH         (VALUE_BITS),
        .DEPTH         (POINTS),
        .ADDRESS_WIDTH (9)
    ) values (
        .clock         (clock),
        .write_enable  (value_valid),
        .write_address (count),
        .write_data    (value),
        .read_enable   (1'b1),
        .read_address  (address),
        .read_data     (value_1)
    );

    // ---- Level: above the least value by the margin, whose leading bit scales the depths below it
    localparam [5:0] TOP = VALUE_BITS[5:0];

    reg [VALUE_BITS-1:0] margin;
    wire [5:0] margin_bits; // two cycles later
    reg [5:0] left;
    reg [VALUE_BITS:0] level;
    wire [47:0] share = {8'd0, stress_sum} >> SHARE_SHIFT;

    sptfra_leading_bit #(
        .WIDTH (48)
    ) leading_bit (
        .clock (clock),
        .value ({ {(48 - VALUE_BITS){1'b0}}, margin}),
        .bits  (margin_bits)
    );

    always @(posedge clock) begin
        // One more, so that the least value is below the level in any case
        margin <= share[VALUE_BITS-1:0] + 1'b1;
        left <= TOP - margin_bits;
        level <= {1'b0, at_bound ? least_on_border : least_inside} + {1'b0, margin};
    end

    // ---- Depths below the level: difference, scaled to 17 bits, squared. Index k: k cycles after the address
    reg level_reading;
    reg [6:1] valid;
    reg corner_1;
    reg corner_2;
    reg signed [VALUE_BITS+1:0] depth_2;
    reg [VALUE_BITS-1:0] depth_3;
    reg [DEPTH_BITS-1:0] depth_4;
    wire [VALUE_BITS-1:0] scaled_3 = depth_3 << left[2:0];
    wire above_2 = depth_2[VALUE_BITS+1];
    wire below_2 = !above_2 && (depth_2[VALUE_BITS:0] != {(VALUE_BITS + 1){1'b0}});
    wire signed [44:0] square_low_5; // the square is their sum
    wire signed [44:0] square_high_5;
    wire signed [44:0] square_5 = square_low_5 + square_high_5;
    reg signed [26:0] weight_6;

    sptfra_multiply square (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient ({1'b0, depth_4}),
        .data        ({ {(27 - DEPTH_BITS){1'b0}}, depth_4}),
        .low         (square_low_5),
        .high        (square_high_5)
    );

    always @(posedge clock) begin
        valid <= {valid[5:1], level_reading};
        corner_1 <= (address == 9'd0) || (address == {4'd0, LAST}) || (address == LAST_POINT - {4'd0, LAST})
            || (address == LAST_POINT);
        corner_2 <= corner_1 && valid[1];
        depth_2 <= {1'b0, level} - {2'b00, value_1};
        depth_3 <= above_2 ? {VALUE_BITS{1'b0}} : depth_2[VALUE_BITS-1:0] << {left[5:3], 3'd0};
        depth_4 <= scaled_3[VALUE_BITS-1:VALUE_BITS-DEPTH_BITS];
        weight_6 <= square_5[WEIGHT_DROP +: 27];
        if (corner_2 && !below_2) begin
            unknown <= 1'b0;
        end
        if (start) begin
            unknown <= 1'b1;
        end
        if (reset) begin
            valid <= 6'd0;
        end
    end

    // ---- Centroid of the weights
    wire divide = (state == DRAIN) && (wait_count == 4'd10);

    sptfra_grid_centroid centroid (
        .clock  (clock),
        .reset  (reset),
        .start  (start),
        .valid  (valid[6]),
        .weight (weight_6),
        .divide (divide),
        .done   (done),
        .mu_x   (mu_x),
        .mu_y   (mu_y)
    );

    // ---- Sequence
    always @(posedge clock) begin
        wait_count <= wait_count + 4'd1;
        case (state)
            IDLE: begin
                address <= 9'd0;
                if (start) begin
                    state <= WALK;
                end
            end
            WALK: begin
                wait_count <= 4'd0;
                at_bound <= (least_on_border < least_inside);
                if (all_there) begin
                    state <= LEAST;
                end
            end
            LEAST: begin
                if (wait_count == 4'd1) begin
                    level_reading <= 1'b1;
                    state <= LEVEL;
                end
            end
            LEVEL: begin
                wait_count <= 4'd0;
                address <= address + 9'd1;
                if (address == LAST_POINT) begin
                    level_reading <= 1'b0;
                    state <= DRAIN;
                end
            end
            DRAIN: begin
                if (divide) begin
                    state <= DIVIDE;
                end
            end
            default: begin
                if (done) begin
                    state <= IDLE;
                end
            end
        endcase
        if (reset) begin
            state <= IDLE;
            level_reading <= 1'b0;
        end
    end

`ifdef SIMULATION
    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (value_valid),
        .done  (done)
    );
`else
    wire _unused_check = (EXPECTED_LATENCY != 0);
`endif

    wire _unused = &{1'b0, share, depth_2, scaled_3, square_5};

endmodule

`default_nettype wire
