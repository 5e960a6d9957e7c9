// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Finds the friction on the line as sptfra_search does, three bits of it a round: the interval is cut into eight.
//
// A pass of all taxels through the cells gives four points, two passes the seven between the parts (the eighth is the
// interval's end and does not count). Six rounds on the sign of the slope of B find its minimum, six on its value both
// ends of the level set, left and right in turn. t has 16 fraction bits.

`default_nettype none

module sptfra_search_eighths #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Taxels that arrive at a time: 4, the members of a quad, or 1
    parameter integer WAYS = 4,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of a quad or taxel
    parameter integer ROW_WIDTH = 5,
    // Cells, as many for each way
    parameter integer CELLS = 28,
    // Taxels of a cell, a power of two
    parameter integer CELL_ELEMENTS = 4,
    // Left shift (negative: right) that turns sum |b| into the level above the least B
    parameter integer LEVEL_SHIFT = -1,
    // From start to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // u_q, way 0 in the lowest bits
    input  wire [2:0] u_valid,
    input  wire [ROW_WIDTH-1:0] u_row,
    input  wire [WAYS*DATA_BITS-1:0] u_values,
    input  wire fill_bank, // of the cells' memories
    input  wire search_bank,
    // Start, with the line held from the next cycle on
    input  wire start,
    input  wire x_is_free,
    input  wire signed [17:0] c0,
    input  wire signed [17:0] c1,
    input  wire [39:0] stress_sum,
    // Result, held until the next one
    output reg  done, // one cycle
    output reg  signed [17:0] t,
    output wire at_bound, // the minimum lies at an end of [-1, 1]
    output reg  saturated
);

    localparam [2:0] LAST_ROUND = 3'd5;
    localparam integer ELEMENT_WIDTH = (CELL_ELEMENTS <= 2) ? 1 : $clog2(CELL_ELEMENTS);
    localparam integer LAST_ELEMENT = CELL_ELEMENTS - 1;
    // From the last taxel's address of a pass to the decision: the cell, the tree, the decision
    localparam integer DECISION_CYCLES = 6 + $clog2(CELLS);
    // The right end is read while the left one waits for its decision, in so many taxels that it is known behind them
    localparam [0:0] KNOWN_IN_TIME = (2 * CELL_ELEMENTS - 1 >= DECISION_CYCLES);
    localparam [17:0] ONE = 18'd65536;
    localparam integer LEVEL_LEFT = (LEVEL_SHIFT > 0) ? LEVEL_SHIFT : 0;
    localparam integer LEVEL_RIGHT = (LEVEL_SHIFT < 0) ? -LEVEL_SHIFT : 0;

    localparam [2:0] IDLE = 3'd0, ALPHA = 3'd1, BETA = 3'd2, SETTLE = 3'd3, SLOPE = 3'd4, FLOOR = 3'd5, LEVEL = 3'd6,
        FINISH = 3'd7;

    reg [2:0] state;
    reg [ELEMENT_WIDTH-1:0] element;
    reg second; // pass of a round: points 5 to 8
    reg right_end; // rather than the left one, or the minimum
    reg reading;
    reg resume; // reading goes on in the next cycle
    reg [1:0] wait_count;

    // ---- Places: of the minimum or the left end, and of the right end
    wire restart; // both
    wire advance_left;
    wire advance_right;
    wire [3:0] count;
    wire [16:0] left;
    wire [16:0] right;
    wire [2:0] left_round;
    wire [2:0] right_round;
    wire signed [17:0] left_first;
    wire signed [17:0] left_second;
    wire signed [17:0] right_first;
    wire signed [17:0] right_second;
    wire [2:0] left_room;
    wire [2:0] right_room;
    reg [16:0] low; // the minimum lies between it and the next place
    reg [17:0] lowest; // which of both is lower
    reg signed [17:0] next_place; // t there

    sptfra_search_place #(
        .BEFORE (1)
    ) place_left (
        .clock   (clock),
        .restart (restart),
        .advance (advance_left),
        .count   (count),
        .lowest  (lowest),
        .place   (left),
        .round   (left_round),
        .first   (left_first),
        .second  (left_second),
        .room    (left_room)
    );

    sptfra_search_place #(
        .BEFORE (0)
    ) place_right (
        .clock   (clock),
        .restart (restart),
        .advance (advance_right),
        .count   (count),
        .lowest  (lowest),
        .place   (right),
        .round   (right_round),
        .first   (right_first),
        .second  (right_second),
        .room    (right_room)
    );

    always @(posedge clock) begin
        next_place <= {1'b0, left} + 18'd1 - ONE;
    end

    reg signed [17:0] factor;
    wire [2:0] round = right_end ? right_round : left_round;

    always @(*) begin
        case (state)
            ALPHA: factor = c0;
            BETA: factor = c1;
            FLOOR: factor = next_place;
            default: factor = right_end ? (second ? right_second : right_first) : (second ? left_second : left_first);
        endcase
    end

    // ---- Cells
    reg signed [47:0] level;
    wire [4*48-1:0] totals;
    wire [3:0] fits_level; // totals <= level
    wire cells_saturated;

    sptfra_search_cells #(
        .COLUMNS       (COLUMNS),
        .ROWS          (ROWS),
        .WAYS          (WAYS),
        .DATA_BITS     (DATA_BITS),
        .ROW_WIDTH     (ROW_WIDTH),
        .CELLS         (CELLS),
        .CELL_ELEMENTS (CELL_ELEMENTS),
        .ELEMENT_WIDTH (ELEMENT_WIDTH),
        .POINTS        (4)
    ) cells (
        .clock      (clock),
        .reset      (reset),
        .u_valid    (u_valid),
        .u_row      (u_row),
        .u_values   (u_values),
        .fill_bank  (fill_bank),
        .read       (reading),
        .bank       (search_bank),
        .element    (element),
        .alpha_pass (state == ALPHA),
        .beta_pass  (state == BETA),
        .x_is_free  (x_is_free),
        .want_slope (state == SLOPE),
        .factor     (factor),
        .round      (round),
        .level      (level),
        .totals     (totals),
        .fits_level (fits_level),
        .saturated  (cells_saturated)
    );

    // ---- Decisions
    wire searching = (state == SLOPE) || (state == LEVEL);
    wire last_element = reading && (element == LAST_ELEMENT[ELEMENT_WIDTH-1:0]);
    wire over; // a pass
    wire over_second;
    wire over_right;
    wire over_last; // of the last round
    wire round_over = over && over_second && searching;

    sptfra_search_decision #(
        .CYCLES     (DECISION_CYCLES),
        .LAST_ROUND (LAST_ROUND)
    ) decision (
        .clock       (clock),
        .reset       (reset),
        .pass_ends   (last_element && (state != ALPHA) && (state != BETA)),
        .second      (second),
        .right_end   (right_end),
        .slope       (state == SLOPE),
        .left_round  (left_round),
        .right_round (right_round),
        .left_room   (left_room),
        .right_room  (right_room),
        .falls       ({totals[4*48-1], totals[3*48-1], totals[2*48-1], totals[48-1]}),
        .fits_level  (fits_level),
        .over        (over),
        .over_second (over_second),
        .over_right  (over_right),
        .over_last   (over_last),
        .count       (count)
    );

    assign advance_left = round_over && !over_right;
    assign advance_right = round_over && over_right;
    assign restart = (state == IDLE) || ((state == FLOOR) && over);

    // ---- The level, from B at the places around the minimum
    reg signed [47:0] floor_low; // B at low, then the lower of both
    reg signed [47:0] floor_high; // B at the next place
    reg [2:0] floor_steps; // both are there; compared; floor_low is B_min, and the level follows
    reg high_is_lower;
    wire [47:0] margin = ({8'd0, stress_sum} << LEVEL_LEFT) >> LEVEL_RIGHT;
    wire [17:0] left_in = (lowest == 18'd0) ? 18'd0 : {1'b0, left} + 18'd1;
    wire [17:0] right_in = lowest[17] ? lowest : {1'b0, right};
    wire [18:0] ends_sum = {1'b0, left_in} + {1'b0, right_in};

    assign at_bound = (low == 17'd0) || (low == 17'h1FFFF);

    // ---- Sequence
    always @(posedge clock) begin
        done <= 1'b0;
        reading <= reading || resume;
        if (reading) begin
            element <= last_element ? {ELEMENT_WIDTH{1'b0}} : element + 1'b1;
            if (last_element) begin
                second <= searching && !second;
                right_end <= (state == LEVEL) && (right_end ^ second);
                reading <= (searching && !second) || ((state == LEVEL) && !right_end)
                    || (KNOWN_IN_TIME && (state == LEVEL) && (left_round <= LAST_ROUND));
            end
        end
        resume <= 1'b0;
        wait_count <= wait_count + 2'd1;
        saturated <= saturated || cells_saturated;
        case (state)
            IDLE: begin
                element <= {ELEMENT_WIDTH{1'b0}};
                second <= 1'b0;
                right_end <= 1'b0;
                if (start) begin
                    saturated <= 1'b0;
                    reading <= 1'b1;
                    state <= ALPHA;
                end
            end
            ALPHA: begin
                if (last_element) begin
                    reading <= 1'b1;
                    state <= BETA;
                end
            end
            BETA: begin
                wait_count <= 2'd0;
                if (last_element) begin
                    state <= SETTLE;
                end
            end
            SETTLE: begin
                if (wait_count == 2'd3) begin
                    reading <= 1'b1;
                    state <= SLOPE;
                end
            end
            SLOPE: begin
                resume <= advance_left;
                if (advance_left && over_last) begin
                    state <= FLOOR;
                end
            end
            FLOOR: begin
                floor_steps <= {floor_steps[1:0], over};
                high_is_lower <= (floor_high < floor_low);
                if (over) begin
                    floor_low <= totals[2*48 +: 48];
                    floor_high <= totals[3*48 +: 48];
                    low <= left;
                end
                if (floor_steps[1]) begin
                    lowest <= {1'b0, low} + {17'd0, high_is_lower};
                    floor_low <= high_is_lower ? floor_high : floor_low;
                end
                if (floor_steps[2]) begin
                    level <= floor_low + margin;
                    reading <= 1'b1;
                    state <= LEVEL;
                end
            end
            LEVEL: begin
                resume <= advance_left && !KNOWN_IN_TIME && !over_last;
                if (advance_right && over_last) begin
                    state <= FINISH;
                end
            end
            default: begin
                t <= ends_sum[18:1] - ONE;
                done <= 1'b1;
                state <= IDLE;
            end
        endcase
        if (reset) begin
            state <= IDLE;
            reading <= 1'b0;
            resume <= 1'b0;
            floor_steps <= 3'd0;
            done <= 1'b0;
            saturated <= 1'b0;
        end
    end

`ifdef SIMULATION
    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (done)
    );
`else
    wire _unused_check = (EXPECTED_LATENCY != 0);
`endif

    // Of a slope its sign, of the level whether it fits
    wire _unused = &{1'b0, totals, ends_sum[0]};

endmodule

`default_nettype wire
