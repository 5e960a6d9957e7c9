// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Finds the friction on the line: t in [-1, 1], the midpoint of the level set of B(t) = sum max(0, alpha_i + t beta_i).
//
// B is Condition 1 (Eq. 20), convex and piecewise linear. 17 bisections on the sign of its slope find the minimum, 17
// more on its value find both ends of {t : B(t) <= B_min + 2^-9 sum |b|}. CELLS cells with up to CELL_ELEMENTS taxels
// each work side by side. t has 16 fraction bits.

`default_nettype none

module sptfra_search #(
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
    parameter integer CELLS = 16,
    // Taxels of a cell, a power of two
    parameter integer CELL_ELEMENTS = 8,
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
    input  wire signed [17:0] next_c0, // c0 of the next cycle, with start
    input  wire signed [17:0] c0,
    input  wire signed [17:0] c1,
    input  wire [39:0] stress_sum,
    // Result, held until the next start
    output reg  done, // one cycle
    output wire signed [17:0] t,
    output wire at_bound, // the minimum lies at an end of [-1, 1]
    output reg  saturated
);

    localparam integer SEARCH_STEPS = 17;
    localparam [4:0] LAST_STEP = SEARCH_STEPS[4:0] - 5'd1;
    localparam integer ELEMENT_WIDTH = (CELL_ELEMENTS <= 2) ? 1 : $clog2(CELL_ELEMENTS);
    localparam integer LAST_ELEMENT = CELL_ELEMENTS - 1;
    // From the last taxel's address of an evaluation to the decision: the cell, the tree, the decision
    localparam integer DECISION_CYCLES = 5 + $clog2(CELLS);
    // The other end is read while one waits for its decision; of so many taxels that it is known when they are over
    localparam [0:0] KNOWN_IN_TIME = (LAST_ELEMENT > DECISION_CYCLES);
    localparam signed [18:0] ONE = 19'sd65536;
    localparam integer LEVEL_LEFT = (LEVEL_SHIFT > 0) ? LEVEL_SHIFT : 0;
    localparam integer LEVEL_RIGHT = (LEVEL_SHIFT < 0) ? -LEVEL_SHIFT : 0;

    localparam [2:0] IDLE = 3'd0, ALPHA = 3'd1, BETA = 3'd2, SETTLE = 3'd3, SLOPE = 3'd4, FLOOR = 3'd5, LEVEL = 3'd6,
        FINISH = 3'd7;

    reg [2:0] state;
    reg [ELEMENT_WIDTH-1:0] element;
    reg second; // of a pair of evaluations
    reg reading;
    reg resume; // reading goes on in the next cycle
    reg [3:0] wait_count;
    reg [4:0] step;

    // ---- The interval of the minimum, then those of the two ends
    reg signed [18:0] low;
    reg signed [18:0] high;
    reg signed [18:0] left_out;
    reg signed [18:0] left_in;
    reg signed [18:0] right_in;
    reg signed [18:0] right_out;
    // What follows a decision is read a cycle later
    reg signed [18:0] left_sum;
    reg signed [18:0] right_sum;
    reg signed [18:0] middle_sum;
    wire signed [18:0] result_sum = left_in + right_in;

    // The factor is a register, which goes all the way to the cells' multipliers: it is chosen for the next cycle
    wire signed [18:0] left = left_out + left_in;
    wire signed [18:0] right = right_in + right_out;
    wire signed [18:0] middle = low + high;
    wire pair = (state == FLOOR) || (state == LEVEL);
    reg raise; // floor_low is B_min: the level follows
    wire last_element;
    wire next_second = last_element ? pair && !second : second;
    reg signed [17:0] factor;

    always @(posedge clock) begin
        case (state)
            IDLE: factor <= next_c0;
            ALPHA: factor <= last_element ? c1 : c0;
            BETA: factor <= c1;
            FLOOR: factor <= raise ? left[18:1] : next_second ? high[17:0] : low[17:0];
            LEVEL: factor <= next_second ? right[18:1] : left[18:1];
            default: factor <= middle[18:1];
        endcase
    end

    // ---- Cells
    reg signed [47:0] level;
    wire signed [47:0] total;
    wire fits_level; // total <= level
    wire cells_saturated;

    sptfra_search_cells #(
        .COLUMNS       (COLUMNS),
        .ROWS          (ROWS),
        .WAYS          (WAYS),
        .DATA_BITS     (DATA_BITS),
        .ROW_WIDTH     (ROW_WIDTH),
        .CELLS         (CELLS),
        .CELL_ELEMENTS (CELL_ELEMENTS),
        .ELEMENT_WIDTH (ELEMENT_WIDTH)
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
        .round      (3'd0),
        .level      (level),
        .totals     (total),
        .fits_level (fits_level),
        .saturated  (cells_saturated)
    );

    // ---- Decisions
    assign last_element = reading && (element == LAST_ELEMENT[ELEMENT_WIDTH-1:0]);
    reg [DECISION_CYCLES-1:1] ends; // of an evaluation; index k: k cycles after its last taxel's address
    reg [DECISION_CYCLES-1:1] seconds;
    reg first_over; // the first evaluation of a pair
    reg step_over; // the only one, or the second
    reg signed [47:0] floor_low; // B at low, then the lower of both ends
    reg signed [47:0] floor_high; // B at high
    reg compare; // both are there
    reg compared;
    reg high_is_lower;
    wire [47:0] margin = ({8'd0, stress_sum} << LEVEL_LEFT) >> LEVEL_RIGHT;

    assign at_bound = (low == -ONE) || (high == ONE);
    assign t = result_sum[18:1];

    always @(posedge clock) begin
        ends <= {ends[DECISION_CYCLES-2:1], last_element && (state != ALPHA) && (state != BETA)};
        seconds <= {seconds[DECISION_CYCLES-2:1], second};
        first_over <= ends[DECISION_CYCLES-1] && pair && !seconds[DECISION_CYCLES-1];
        step_over <= ends[DECISION_CYCLES-1] && (!pair || seconds[DECISION_CYCLES-1]);
        if (reset) begin
            ends <= {(DECISION_CYCLES - 1){1'b0}};
            first_over <= 1'b0;
            step_over <= 1'b0;
        end
    end

    // ---- Sequence
    always @(posedge clock) begin
        done <= 1'b0;
        if (reading) begin
            element <= last_element ? {ELEMENT_WIDTH{1'b0}} : element + 1'b1;
            if (last_element) begin
                second <= pair && !second;
                reading <= (pair && !second) || (KNOWN_IN_TIME && (state == LEVEL) && (step != LAST_STEP));
            end
        end
        resume <= 1'b0;
        if (resume) begin
            reading <= 1'b1;
        end
        left_sum <= left;
        right_sum <= right;
        middle_sum <= middle;
        wait_count <= wait_count + 4'd1;
        if (cells_saturated) begin
            saturated <= 1'b1;
        end
        case (state)
            IDLE: begin
                element <= {ELEMENT_WIDTH{1'b0}};
                second <= 1'b0;
                step <= 5'd0;
                if (start) begin
                    saturated <= 1'b0;
                    reading <= 1'b1;
                    state <= ALPHA;
                end
            end
            ALPHA: begin
                low <= -ONE;
                high <= ONE;
                if (last_element) begin
                    reading <= 1'b1;
                    state <= BETA;
                end
            end
            BETA: begin
                wait_count <= 4'd0;
                if (last_element) begin
                    state <= SETTLE;
                end
            end
            SETTLE: begin
                if (wait_count == 4'd3) begin
                    reading <= 1'b1;
                    state <= SLOPE;
                end
            end
            SLOPE: begin
                if (step_over) begin
                    if (total[47]) begin
                        low <= {middle_sum[18], middle_sum[18:1]};
                    end else begin
                        high <= {middle_sum[18], middle_sum[18:1]};
                    end
                    resume <= 1'b1;
                    step <= step + 5'd1;
                    if (step == LAST_STEP) begin
                        step <= 5'd0;
                        state <= FLOOR;
                    end
                end
            end
            FLOOR: begin
                left_out <= -ONE;
                right_out <= ONE;
                raise <= 1'b0;
                if (raise) begin
                    level <= floor_low + margin;
                    reading <= 1'b1;
                    state <= LEVEL;
                end
                if (first_over) begin
                    floor_low <= total;
                end
                compare <= step_over;
                compared <= compare;
                high_is_lower <= (floor_high < floor_low);
                if (step_over) begin
                    floor_high <= total;
                end
                if (compared) begin
                    left_in <= high_is_lower ? high : low;
                    right_in <= high_is_lower ? high : low;
                    floor_low <= high_is_lower ? floor_high : floor_low;
                    raise <= 1'b1;
                end
            end
            LEVEL: begin
                if (first_over) begin
                    if (fits_level) begin
                        left_in <= {left_sum[18], left_sum[18:1]};
                    end else begin
                        left_out <= {left_sum[18], left_sum[18:1]};
                    end
                    resume <= !KNOWN_IN_TIME && (step != LAST_STEP);
                end
                if (step_over) begin
                    if (fits_level) begin
                        right_in <= {right_sum[18], right_sum[18:1]};
                    end else begin
                        right_out <= {right_sum[18], right_sum[18:1]};
                    end
                    step <= step + 5'd1;
                    if (step == LAST_STEP) begin
                        state <= FINISH;
                    end
                end
            end
            default: begin
                done <= 1'b1;
                state <= IDLE;
            end
        endcase
        if (reset) begin
            state <= IDLE;
            reading <= 1'b0;
            resume <= 1'b0;
            compare <= 1'b0;
            compared <= 1'b0;
            raise <= 1'b0;
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

    wire _unused = &{1'b0, left_sum[0], right_sum[0], middle_sum[0], result_sum[0]};

endmodule

`default_nettype wire
